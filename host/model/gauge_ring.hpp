#pragma once
// The gauges around a finger, each where it is.

#include <Eigen/Core>
#include <vector>

#include "common/quantities.hpp"
#include "host/model/annulus.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/load_spectrum.hpp"
#include "host/model/placed_gauge.hpp"

namespace strainfinger::model {

/// What a ring of gauges reads under loads that are spread. Linear in the load.
class GaugeRing {
 public:
  /// The gauges average over gaugeArc_m. Domain, errors and tolerance as ImpulseResponse. Costs 0.1 ms for
  /// every radius in a row that differs from the one before.
  GaugeRing(const Annulus<double>& annulus, std::vector<PlacedGauge> gauges, StrainComponent component,
            double gaugeArc_m = 0, double tolerance = 1e-15);

  struct Readings {
    Eigen::VectorXd strains;  ///< gains included
    Eigen::VectorXd slopes;   ///< their derivative to the load's place, per rad
  };

  /// Under a load centred at centre_rad, whose spectrum has harmonics() or more. Costs 0.5 us a gauge.
  Readings under(const LoadSpectrum& load, double centre_rad) const;

  int count() const { return static_cast<int>(gauges_.size()); }
  const PlacedGauge& gauge(int index) const { return gauges_[static_cast<std::size_t>(index)]; }
  /// The last harmonic that any of the gauges feels.
  int harmonics() const { return harmonics_; }

 private:
  std::vector<PlacedGauge> gauges_;
  std::vector<ImpulseResponse> responses_;  ///< one a gauge
  int harmonics_ = 0;
};

}  // namespace strainfinger::model
