#include "host/simulation/noise.hpp"

#include <cmath>
#include <numbers>

namespace strainfinger::simulation {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9E3779B97F4A7C15;
constexpr std::uint64_t kChannels = 32;

constexpr std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
  return z ^ (z >> 31);
}

/// [0, 1) in steps of 2^-53.
double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

}  // namespace

Noise::Noise(std::uint64_t seed) : key_(mix(seed + kGoldenGamma)) {}

double Noise::at(std::uint64_t sample, std::uint32_t channel) const {
  const std::uint64_t index = 2 * (sample * kChannels + channel);
  const double radius = std::sqrt(-2 * std::log(1 - unit(mix(key_ + index * kGoldenGamma))));
  return radius * std::cos(2 * std::numbers::pi * unit(mix(key_ + (index + 1) * kGoldenGamma)));
}

}  // namespace strainfinger::simulation
