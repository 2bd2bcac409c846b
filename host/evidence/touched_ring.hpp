#pragma once
// What the ring of a finger reads of touches.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "host/config/finger_config.hpp"
#include "host/simulation/converter.hpp"
#include "host/simulation/gauge_strains.hpp"
#include "host/simulation/noise.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::evidence {

/// Readings with white noise, addressed by the seed and a number.
class TouchedRing {
 public:
  /// The finger is as simulation::builtFinger() has it.
  TouchedRing(const config::FingerConfig& config, std::uint64_t seed);

  /// One strain a gauge as it reads, gains included, without noise. For several readings of one touch: the
  /// costly part of it.
  Eigen::VectorXd exact(std::span<const simulation::Touch> touches) const {
    return strains_.readings(touches);
  }
  Eigen::VectorXd exact(const simulation::Touch& touch) const { return exact({&touch, 1}); }

  /// Conditioned readings: with gauges.noise_strain, quantisation being a part of it.
  Eigen::VectorXd noisy(const Eigen::VectorXd& exact, std::uint64_t number) const;

  /// What the converter makes of them: with so much noise before it that a reading has gauges.noise_strain.
  std::vector<std::uint16_t> codes(const Eigen::VectorXd& exact, std::uint64_t number) const;

  const simulation::GaugeStrains& strains() const { return strains_; }

 private:
  simulation::GaugeStrains strains_;
  simulation::Converter converter_;
  double noise_strain_;
  double analogNoise_strain_;
  simulation::Noise noise_;
};

/// As the firmware's conditioning would hand them on: StrainQ32, rounded, saturated.
std::vector<std::int32_t> conditioned_q32(const Eigen::VectorXd& readings);

}  // namespace strainfinger::evidence
