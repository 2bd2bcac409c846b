#include "host/simulation/built_finger.hpp"

#include <algorithm>
#include <numbers>

#include "host/base/angles.hpp"
#include "host/simulation/noise.hpp"

namespace strainfinger::simulation {
namespace {

/// Sample numbers of the draws.
enum Draw : std::uint64_t { kAngle, kDepth, kGain };
/// Added to as_built.seed, so that small seeds of a run's noise don't repeat the draws.
constexpr std::uint64_t kSeedsBase = std::uint64_t{1} << 40;

}  // namespace

BuiltFinger builtFinger(const config::FingerConfig& config) {
  const config::AsBuilt& differs = config.as_built;
  BuiltFinger built{config.finger.annulus(), {}};
  built.annulus.core_radius_m += differs.core_radius_m;
  built.annulus.poisson_ratio += differs.poisson_ratio;
  built.annulus.shear_modulus_pa += differs.shear_modulus_pa;
  const Noise draws(kSeedsBase + static_cast<std::uint64_t>(differs.seed));
  const double outermost_m = (config.gauges.radius_m + config.finger.outer_radius_m) / 2;
  for (int i = 0; i < config.gauges.count; ++i) {
    if (differs.isAsDrawn()) {
      built.gauges.push_back(config.calibrated(i));
      continue;
    }
    const auto draw = [&](Draw which) { return draws.at(which, static_cast<std::uint32_t>(i)); };
    model::PlacedGauge gauge = config.drawn(i);
    gauge.angle_rad += differs.angle_deg * kRadPerDeg * draw(kAngle);
    gauge.radius_m =
        std::clamp(gauge.radius_m - differs.depth_m * draw(kDepth), built.annulus.core_radius_m, outermost_m);
    gauge.gain *= 1 + differs.gain * draw(kGain);
    built.gauges.push_back(gauge);
  }
  return built;
}

}  // namespace strainfinger::simulation
