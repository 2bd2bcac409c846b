#include "host/tables/gauge_gains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strainfinger::tables {
namespace {

constexpr double kMostCorrection = std::numeric_limits<std::int8_t>::max();

int exponentFor(double largest) {
  int exponent = kMostGainExponent;
  while (exponent > kLeastGainExponent && std::ldexp(largest, exponent) > kMostCorrection) --exponent;
  return exponent;
}

}  // namespace

GaugeGains gaugeGains(const config::FingerConfig& config) {
  GaugeGains gains{};
  const std::vector<double>& gain = config.calibration.gain;
  if (gain.empty()) return gains;
  double largest = 0;
  for (const double each : gain) largest = std::max(largest, std::abs(1 / each - 1));
  const int exponent = exponentFor(largest);
  gains.exponent = static_cast<std::uint8_t>(exponent);
  std::transform(gain.begin(), gain.end(), gains.correction.begin(), [&](double each) {
    return static_cast<std::int8_t>(std::lround(std::ldexp(1 / each - 1, exponent)));
  });
  return gains;
}

std::vector<double> correctionFactors(const GaugeGains& gains, int count) {
  std::vector<double> factors;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    factors.push_back(1 + std::ldexp(gains.correction[i], -gains.exponent));
  return factors;
}

}  // namespace strainfinger::tables
