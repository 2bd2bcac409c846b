#include "host/tables/gauge_gains.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/base/failure.hpp"

namespace strainfinger::tables {
namespace {

/// What the largest correction leaves, 1 / gain - 1.
const double kLeastGain =
    1 / (1 + std::ldexp(std::numeric_limits<std::int16_t>::max(), -GaugeGains::kFracBits));

/// The largest full scale of a gauge that the firmware's words hold, of 2^34 for a gain of 1.
const double kMostFullScale = std::ldexp(std::ldexp(1, 16 + kMostGateShift) - 2, -34);

void requireHeld(const config::FingerConfig& config, std::size_t gauge, double gain) {
  const double fullScale = config.gauges.full_scale_strain / gain;
  if (fullScale <= kMostFullScale) return;
  throw Failure(ExitCode::kUsage,
                fmt::format("gauges.full_scale_strain = {}: gauge {} reads {:.3g} of what the others do "
                            "(calibration.gain, calibration.depth_offset_m), which makes its full scale "
                            "{:.4g}; the firmware holds {:.4g}: amplify more, so that the full scale is "
                            "smaller",
                            config.gauges.full_scale_strain, gauge, gain, fullScale, kMostFullScale));
}

/// What each gauge reads over what the tables say it does.
std::vector<double> totalGains(const config::FingerConfig& config, const DepthFit& depths) {
  std::vector<double> gains = depths.gain;
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
    requireHeld(config, i, gains[i]);
  }
  return gains;
}

}  // namespace

GaugeGains gaugeGains(const config::FingerConfig& config, const DepthFit& depths) {
  GaugeGains gains{};
  if (config.calibration.gain.empty() && config.calibration.depth_offset_m.empty()) return gains;
  const std::vector<double> total = totalGains(config, depths);
  gains.are_known = 1;
  std::transform(total.begin(), total.end(), gains.correction_q14.begin(), [](double each) {
    return static_cast<std::int16_t>(std::lround(std::ldexp(1 / each - 1, GaugeGains::kFracBits)));
  });
  return gains;
}

std::vector<double> correctionFactors(const GaugeGains& gains, int count) {
  std::vector<double> factors;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    factors.push_back(1 + std::ldexp(gains.correction_q14[i], -GaugeGains::kFracBits));
  return factors;
}

}  // namespace strainfinger::tables
