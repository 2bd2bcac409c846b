#include "host/cli/model_options.hpp"

#include <fmt/format.h>

#include <string>

#include "host/base/failure.hpp"

namespace strainfinger::cli {

void requireInRubber(double radius_m, const config::Finger& finger) {
  if (radius_m >= finger.core_radius_m && radius_m <= finger.outer_radius_m) return;
  throw Failure(
      ExitCode::kUsage,
      fmt::format("--radius-m: {} m is outside the rubber; it must be from {} (core_radius_m) to {} "
                  "(outer_radius_m)",
                  radius_m, finger.core_radius_m, finger.outer_radius_m));
}

std::vector<double> evenly(double from, double to, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(from + (to - from) * i / (count - 1));
  values.back() = to;
  return values;
}

}  // namespace strainfinger::cli
