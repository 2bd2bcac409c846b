#include "host/cli/model_options.hpp"

#include <fmt/format.h>

#include <string>

#include "host/base/failure.hpp"

namespace strainfinger::cli {

CLI::Validator realFrom(double least, double most) {
  const auto complaint = [least, most](const std::string& text) -> std::string {
    double value = 0;
    const bool isReal = CLI::detail::lexical_cast(text, value);
    if (isReal && value >= least && value <= most) return {};
    return fmt::format("{} is not a number from {} to {}", text, least, most);
  };
  return CLI::Validator(complaint, "");
}

void requireInRubber(double radius_m, const config::Finger& finger) {
  if (radius_m >= finger.core_radius_m && radius_m <= finger.outer_radius_m) return;
  throw Failure(
      ExitCode::kUsage,
      fmt::format("--radius-m: {} m is outside the rubber; it must be from {} (core_radius_m) to {} "
                  "(outer_radius_m)",
                  radius_m, finger.core_radius_m, finger.outer_radius_m));
}

}  // namespace strainfinger::cli
