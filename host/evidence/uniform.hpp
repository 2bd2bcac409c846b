#pragma once
// Even draws of a noise that is normal.

#include <cmath>
#include <cstdint>
#include <numbers>

#include "host/simulation/noise.hpp"

namespace strainfinger::evidence {

/// Uniform in -1/2 .. 1/2, of the two channels that begin at `channel`.
inline double uniform(const simulation::Noise& noise, std::uint64_t sample, std::uint32_t channel) {
  return std::atan2(noise.at(sample, channel), noise.at(sample, channel + 1)) / (2 * std::numbers::pi);
}

}  // namespace strainfinger::evidence
