#pragma once
// Touches to the strains the gauges really have.

#include <Eigen/Core>
#include <array>
#include <span>

#include "common/quantities.hpp"
#include "host/config/finger_config.hpp"
#include "host/model/gauge_ring.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/touch_load.hpp"
#include "host/simulation/built_finger.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::simulation {

using Strains = std::array<double, kMaxGauges>;

/// What a touch puts on a finger of this radius, with the config's friction, and its width and a uniform
/// pressure where the touch has no width of its own.
model::TouchLoad loadOf(const Touch& touch, const config::Contact& contact, double outerRadius_m);

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

  /// What every gauge reads: its strain times its gain.
  Eigen::VectorXd readings(std::span<const Touch> touches) const;

  double gaugeAngle_rad(int gauge) const { return ring_.gauge(gauge).angle_rad; }
  /// What a gauge reads over the strain that it has.
  double gain(int gauge) const { return ring_.gauge(gauge).gain; }
  int count() const { return ring_.count(); }

 private:
  GaugeStrains(const config::FingerConfig& config, const BuiltFinger& built);
  model::LoadSpectrum spectrumOf(const Touch& touch) const;

  config::Contact contact_;
  double outerRadius_m_;
  model::GaugeRing ring_;
  model::ImpulseResponse drawn_;
};

}  // namespace strainfinger::simulation
