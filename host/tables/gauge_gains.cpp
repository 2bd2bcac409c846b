#include "host/tables/gauge_gains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {
namespace {

constexpr double kMostCorrection = std::numeric_limits<std::int8_t>::max();

/// What 1 / gain - 1 <= kMostCorrection / 2^kLeastGainExponent leaves.
const double kLeastGain = 1 / (1 + std::ldexp(kMostCorrection, -kLeastGainExponent));

int exponentFor(double largest) {
  int exponent = kMostGainExponent;
  while (exponent > kLeastGainExponent && std::ldexp(largest, exponent) > kMostCorrection) --exponent;
  return exponent;
}

constexpr double kGainTolerance = 1e-6;  ///< of the responses; gains are rounded to 3e-5 at best

model::ImpulseResponse responseAt(const config::FingerConfig& config, double radius_m) {
  return {config.finger.annulus(),    radius_m, config.gauges.component,
          config.gauges.arc_length_m, 0,        kGainTolerance};
}

/// Integral over a revolution of the products of two gauges' responses to a normal and to a tangential line
/// load (Parseval), but for a factor.
double product(const model::ImpulseResponse& a, const model::ImpulseResponse& b) {
  const Eigen::Index count = std::min(a.even().size(), b.even().size());
  return a.even().head(count).dot(b.even().head(count)) + a.even()[0] * b.even()[0] +
         a.odd().head(count).dot(b.odd().head(count));
}

/// The factor between the readings of gauges at their own depths and at the drawing's that fits best over all
/// angles. What it leaves of a response that is also wider or narrower is part of the model's error.
std::vector<double> depthGains(const config::FingerConfig& config) {
  const auto count = static_cast<std::size_t>(config.gauges.count);
  if (config.calibration.depth_offset_m.empty()) return std::vector<double>(count, 1);
  const model::ImpulseResponse drawn = responseAt(config, config.gauges.radius_m);
  std::vector<double> gains;
  for (int gauge = 0; gauge < config.gauges.count; ++gauge)
    gains.push_back(product(responseAt(config, config.calibrated(gauge).radius_m), drawn) /
                    product(drawn, drawn));
  return gains;
}

constexpr int kDepthAngles = 720;  ///< over a revolution, at which responses are compared

/// The largest difference between a response and `gain` times the drawn one, to either load.
double largestDifference(const model::ImpulseResponse& response, double gain,
                         const model::ImpulseResponse& drawn) {
  double largest = 0;
  for (int i = 0; i < kDepthAngles; ++i) {
    const double angle_rad = 2 * std::numbers::pi * i / kDepthAngles;
    const auto here = response.at(angle_rad), there = drawn.at(angle_rad);
    largest = std::max({largest, std::abs(here.normal - gain * there.normal),
                        std::abs(here.tangential - gain * there.tangential)});
  }
  return largest;
}

double largestResponse(const model::ImpulseResponse& drawn) {
  double largest = 0;
  for (int i = 0; i < kDepthAngles; ++i)
    largest = std::max(largest, std::abs(drawn.at(2 * std::numbers::pi * i / kDepthAngles).normal));
  return largest;
}

/// What each gauge reads over what the tables say it does.
std::vector<double> totalGains(const config::FingerConfig& config) {
  std::vector<double> gains = depthGains(config);
  for (std::size_t i = 0; i < gains.size(); ++i) {
    gains[i] *= config.calibrated(static_cast<int>(i)).gain;
    if (!(gains[i] >= kLeastGain))
      throw Failure(
          ExitCode::kUsage,
          fmt::format("calibration.depth_offset_m[{}] = {}: so deep, and with its calibration.gain, the "
                      "gauge reads {:.3g} of what the others do; the tables correct {:.3g} and more: "
                      "calibrate anew, or leave that gauge's depth out",
                      i, config.calibration.depth_offset_m.empty() ? 0 : config.calibration.depth_offset_m[i],
                      gains[i], kLeastGain));
  }
  return gains;
}

}  // namespace

GaugeGains gaugeGains(const config::FingerConfig& config) {
  GaugeGains gains{};
  if (config.calibration.gain.empty() && config.calibration.depth_offset_m.empty()) return gains;
  const std::vector<double> total = totalGains(config);
  double largest = 0;
  for (const double each : total) largest = std::max(largest, std::abs(1 / each - 1));
  const int exponent = exponentFor(largest);
  gains.exponent = static_cast<std::uint8_t>(exponent);
  std::transform(total.begin(), total.end(), gains.correction.begin(), [&](double each) {
    return static_cast<std::int8_t>(std::lround(std::ldexp(1 / each - 1, exponent)));
  });
  return gains;
}

double depthError(const config::FingerConfig& config) {
  if (config.calibration.depth_offset_m.empty()) return 0;
  const model::ImpulseResponse drawn = responseAt(config, config.gauges.radius_m);
  const std::vector<double> gains = depthGains(config);
  double squares = 0;
  for (std::size_t i = 0; i < gains.size(); ++i) {
    const double radius_m = config.calibrated(static_cast<int>(i)).radius_m;
    squares += std::pow(largestDifference(responseAt(config, radius_m), gains[i], drawn), 2);
  }
  return std::sqrt(squares / static_cast<double>(gains.size())) / largestResponse(drawn);
}

std::vector<double> correctionFactors(const GaugeGains& gains, int count) {
  std::vector<double> factors;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    factors.push_back(1 + std::ldexp(gains.correction[i], -gains.exponent));
  return factors;
}

}  // namespace strainfinger::tables
