#pragma once
// Touches to the strains the gauges really have.

#include <array>
#include <span>
#include <vector>

#include "common/quantities.hpp"
#include "host/config/finger_config.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/touch_load.hpp"
#include "host/simulation/built_finger.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::simulation {

using Strains = std::array<double, kMaxGauges>;

/// The elastic model at each gauge of the finger as it was built. Loads superpose: the finger is linear. A
/// semi-elliptic pressure has the shear of Mindlin's partial slip, with the config's friction.
class GaugeStrains {
 public:
  explicit GaugeStrains(const config::FingerConfig& config);

  /// Strain of every gauge of the ring, zero beyond. Relative error below 1e-9 of the peak of each touch.
  /// Costs 0.4 us a gauge and touch, and 20 to 60 us a touch that has a width.
  Strains under(std::span<const Touch> touches) const;

  /// Strain at any angle of the ring, as a gauge there would have it that is as deep as drawn.
  double at(double angle_rad, std::span<const Touch> touches) const;

  double gaugeAngle_rad(int gauge) const { return placed(gauge).angle_rad; }
  /// What a gauge reads over the strain that it has.
  double gain(int gauge) const { return placed(gauge).gain; }
  int count() const { return static_cast<int>(built_.gauges.size()); }

 private:
  const config::PlacedGauge& placed(int gauge) const {
    return built_.gauges[static_cast<std::size_t>(gauge)];
  }
  model::TouchLoad loadOf(const Touch& touch) const;
  model::ImpulseResponse responseAt(double radius_m, const config::Gauges& gauges) const;

  config::Contact contact_;
  BuiltFinger built_;
  model::ImpulseResponse drawn_;
  std::vector<model::ImpulseResponse> responses_;  ///< of each gauge
  int harmonics_;                                  ///< that all of them need
};

}  // namespace strainfinger::simulation
