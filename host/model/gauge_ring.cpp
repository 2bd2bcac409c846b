#include "host/model/gauge_ring.hpp"

#include <algorithm>

namespace strainfinger::model {

GaugeRing::GaugeRing(const Annulus<double>& annulus, std::vector<PlacedGauge> gauges,
                     StrainComponent component, double gaugeArc_m, double tolerance)
    : gauges_(std::move(gauges)) {
  for (std::size_t i = 0; i < gauges_.size(); ++i) {
    const double radius_m = gauges_[i].radius_m;
    if (i > 0 && radius_m == gauges_[i - 1].radius_m)
      responses_.push_back(responses_.back());
    else
      responses_.emplace_back(annulus, radius_m, component, gaugeArc_m, 0, tolerance);
    harmonics_ = std::max(harmonics_, responses_.back().harmonics());
  }
}

GaugeRing::Readings GaugeRing::under(const LoadSpectrum& load, double centre_rad) const {
  Readings readings{Eigen::VectorXd(count()), Eigen::VectorXd(count())};
  for (int i = 0; i < count(); ++i) {
    const PlacedGauge& placed = gauge(i);
    const auto felt = responses_[static_cast<std::size_t>(i)].under(load, placed.angle_rad - centre_rad);
    readings.strains[i] = placed.gain * felt.strain;
    readings.slopes[i] = -placed.gain * felt.slope;  // the gauge's angle falls as the load's grows
  }
  return readings;
}

}  // namespace strainfinger::model
