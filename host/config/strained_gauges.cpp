#include "host/config/strained_gauges.hpp"

#include <fmt/format.h>

#include "host/base/failure.hpp"
#include "host/config/keys.hpp"

namespace strainfinger::config {
namespace {

/// Of the strain at the gauges to load / (shear modulus * radius): that of usual gauges is about one, what
/// rounding leaves of none at all 1e-16.
constexpr double kLeastResponse = 1e-12;

}  // namespace

void requireStrain(const FingerConfig& config, double strainPerLoad) {
  const double response = strainPerLoad * config.finger.shear_modulus_pa * config.finger.outer_radius_m;
  if (response >= kLeastResponse) return;
  throw Failure(
      ExitCode::kUsage,
      fmt::format("gauges.radius_m = {} is on the core, where the rubber has no {} strain "
                  "(finger.core_radius_m = {}): move the gauges outwards, or read another gauges.component",
                  config.gauges.radius_m, componentName(config.gauges.component),
                  config.finger.core_radius_m));
}

}  // namespace strainfinger::config
