#include <fmt/format.h>

#include <numbers>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/contact/slope_map.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kSvdHelp =
    "Singular values of the paper's map T C, from Hanning-windowed Fourier coefficients of pressure and "
    "shear up to half the harmonics to the slope of the surface in the contact [m/(rad Pa)], largest "
    "first. They are those of the slope at 2 n_c + 4 even points, as printed, and grow with the root of "
    "their number: relative ones don't.\n"
    "With --basis K the first K pairs instead: u_r and its slope d u_r / d theta against the angle from "
    "the contact's centre, and the pressure (positive when pressing) and shear that make them, per unit "
    "of coefficients. Pairs are even or odd: an even shape has an odd slope and an even pressure.";

struct SvdOptions {
  explicit SvdOptions(CLI::App& command) : common(command) {
    command.add_option("--width-m", width_m, "Width of the contact, an arc on the surface [m]")
        ->required()
        ->type_name("W");
    command
        .add_option(
            "--harmonics", harmonics,
            fmt::format("Last harmonic n_c ({} to {})", contact::kLeastHarmonics, contact::kMostHarmonics))
        ->required()
        ->type_name("N")
        ->check(isWhole(contact::kLeastHarmonics, contact::kMostHarmonics));
    auto* const withBasis =
        command.add_option("--basis", basis, "Prints the first K shape and pressure functions")
            ->type_name("K")
            ->check(isWhole(1, 10'000));
    command
        .add_option("--points", points, fmt::format("Angles over the width that --basis prints ({})", points))
        ->needs(withBasis)
        ->type_name("N")
        ->check(isWhole(2, 100'000));
    command
        .add_option("--rows", rows,
                    "gauss (default): the continuum's values; printed: the paper's even points")
        ->check(CLI::IsMember({"gauss", "printed"}));
    command
        .add_option("--window", window,
                    "Last coefficient of the window: half (default) of n_c, as printed, or full")
        ->check(CLI::IsMember({"half", "full"}));
    command.add_flag("--frictionless", frictionless, "Leaves out the shear");
  }
  CommonOptions common;
  double width_m = 0;
  int harmonics = 0;
  int basis = 0;
  int points = 101;
  std::string rows = "gauss";
  std::string window = "half";
  bool frictionless = false;
};

void printValues(const SvdOptions& options, const std::vector<contact::SingularPair>& pairs) {
  TableWriter table(stdout, options.common.format(), {"index", "singular_value", "relative"});
  for (std::size_t i = 0; i < pairs.size(); ++i)
    table.row({static_cast<std::int64_t>(i + 1), pairs[i].value, pairs[i].value / pairs[0].value});
}

void printBasis(const SvdOptions& options, const config::Finger& finger, const contact::SlopeMap& map,
                const std::vector<contact::SingularPair>& pairs) {
  TableWriter table(stdout, options.common.format(),
                    {"index", "angle_deg", "shape_m", "slope", "pressure_pa", "shear_pa"});
  for (std::size_t i = 0; i < static_cast<std::size_t>(options.basis); ++i) {
    const auto tractions = map.tractions(pairs[i].isEvenSlope, pairs[i].unknowns);
    for (int k = 0; k < options.points; ++k) {
      const double angle_rad = options.width_m / finger.outer_radius_m * (k / (options.points - 1.0) - 0.5);
      const contact::SurfacePoint point = contact::surfaceAt(finger.annulus(), tractions, angle_rad);
      const contact::Traction traction = contact::tractionAt(tractions, angle_rad);
      table.row({static_cast<std::int64_t>(i + 1), angle_rad / kRadPerDeg, point.ur_m, point.urSlope_m,
                 traction.pressure_pa, traction.shear_pa});
    }
  }
}

void requireWidth(double width_m, const config::Finger& finger) {
  const double widest_m = std::numbers::pi * finger.outer_radius_m;
  if (width_m > 0 && width_m <= widest_m) return;
  throw Failure(ExitCode::kUsage,
                fmt::format("--width-m {}: the width must be above 0 and at most half the surface, {:.6g} m",
                            width_m, widest_m));
}

void requirePairs(std::size_t asked, std::size_t pairs) {
  if (asked <= pairs) return;
  throw Failure(ExitCode::kUsage, fmt::format("--basis {}: there are {} pairs; more need more --harmonics, "
                                              "or a wider --width-m",
                                              asked, pairs));
}

void runSvd(const SvdOptions& options) {
  const config::Finger finger = options.common.config().finger;
  requireWidth(options.width_m, finger);
  contact::SlopeMapRequest request;
  request.width_rad = options.width_m / finger.outer_radius_m;
  request.harmonics = options.harmonics;
  request.withShear = !options.frictionless;
  if (options.rows == "printed") request.rows = contact::SlopeRows::kPrinted;
  if (options.window == "full") request.window = contact::WindowCut::kFull;
  const contact::SlopeMap map(finger.annulus(), request);
  const auto pairs = contact::singularPairs(map);
  requirePairs(static_cast<std::size_t>(options.basis), pairs.size());
  if (options.basis > 0)
    printBasis(options, finger, map, pairs);
  else
    printValues(options, pairs);
}

}  // namespace

void addSvd(CLI::App& app) { addCommand<SvdOptions>(app, "svd", kSvdHelp, runSvd); }

}  // namespace strainfinger::cli
