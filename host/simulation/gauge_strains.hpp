#pragma once
// Touches to the strains the gauges really have.

#include <array>
#include <span>

#include "common/quantities.hpp"
#include "host/config/finger_config.hpp"
#include "host/model/impulse_response.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::simulation {

using Strains = std::array<double, kMaxGauges>;

/// The elastic model at each gauge. Loads superpose: the finger is linear.
class GaugeStrains {
 public:
  explicit GaugeStrains(const config::FingerConfig& config);

  /// Strain of every gauge of the ring, zero beyond. Relative error below 1e-9 of the peak of each touch.
  Strains under(std::span<const Touch> touches) const;

  /// Strain at any angle of the ring, as a gauge there would have it.
  double at(double angle_rad, std::span<const Touch> touches) const;

  double gaugeAngle_rad(int gauge) const;
  int count() const { return gauges_.count; }

 private:
  config::Gauges gauges_;
  model::ImpulseResponse response_;
};

}  // namespace strainfinger::simulation
