#include "host/simulation/gauge_strains.hpp"

#include <algorithm>

namespace strainfinger::simulation {
namespace {

constexpr double kTolerance = 1e-9;  ///< of the peak: four orders below a step of a 16-bit converter

}  // namespace

GaugeStrains::GaugeStrains(const config::FingerConfig& config)
    : contact_(config.contact),
      built_(builtFinger(config)),
      drawn_(responseAt(config.gauges.radius_m, config.gauges)),
      harmonics_(drawn_.harmonics()) {
  for (const config::PlacedGauge& gauge : built_.gauges) {
    responses_.push_back(responseAt(gauge.radius_m, config.gauges));
    harmonics_ = std::max(harmonics_, responses_.back().harmonics());
  }
}

model::ImpulseResponse GaugeStrains::responseAt(double radius_m, const config::Gauges& gauges) const {
  return {built_.annulus, radius_m, gauges.component, gauges.arc_length_m, 0, kTolerance};
}

model::TouchLoad GaugeStrains::loadOf(const Touch& touch) const {
  const model::Profile profile = touch.width_m ? touch.profile : model::Profile::kUniform;
  const double width_m = touch.width_m.value_or(contact_.width_m.value_or(0));
  return {touch.normal_n_per_m, touch.tangential_n_per_m,
          model::momentOf(profile, width_m / built_.annulus.outer_radius_m), profile,
          contact_.friction_coefficient};
}

Strains GaugeStrains::under(std::span<const Touch> touches) const {
  Strains strains{};
  for (const Touch& touch : touches) {
    const model::LoadSpectrum spectrum = trueSpectrum(loadOf(touch), harmonics_);
    for (std::size_t gauge = 0; gauge < responses_.size(); ++gauge)
      strains[gauge] +=
          responses_[gauge].under(spectrum, built_.gauges[gauge].angle_rad - touch.angle_rad).strain;
  }
  return strains;
}

double GaugeStrains::at(double angle_rad, std::span<const Touch> touches) const {
  double strain = 0;
  for (const Touch& touch : touches)
    strain += drawn_.under(trueSpectrum(loadOf(touch), harmonics_), angle_rad - touch.angle_rad).strain;
  return strain;
}

}  // namespace strainfinger::simulation
