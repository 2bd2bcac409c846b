#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/base/notice.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/model_options.hpp"
#include "host/model/field.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kStrainHelp =
    "Strains (tensor components, extension positive), displacements and stresses under a load on the "
    "surface, at a radius and a list of angles.\n"
    "The load is a line load, or uniform over --width-m. At the surface itself a line load has no field; one "
    "of some width has, but at the edges of a tangential one err, ett and ttt_pa grow as logarithms without "
    "end and are inf (null in JSON).";

constexpr double kMostLoad_n_per_m = 1e12;
constexpr double kMostAngle_deg = 1e6;
constexpr int kMostPoints = 1'000'000;

struct StrainOptions {
  explicit StrainOptions(CLI::App& command) : common(command) {
    const auto load = isFrom(-kMostLoad_n_per_m, kMostLoad_n_per_m);
    const auto angle = isFrom(-kMostAngle_deg, kMostAngle_deg);
    command.add_option("--radius-m", radius_m, "Radius to look at [m]")
        ->required()
        ->type_name("R")
        ->check(isFrom(0, 1));
    command.add_option("--normal-n-per-m", normal_n_per_m, "Normal line load [N/m], positive when pressing")
        ->required()
        ->type_name("P")
        ->check(load);
    command
        .add_option("--tangential-n-per-m", tangential_n_per_m,
                    "Tangential line load [N/m], to +theta; 0 without it")
        ->type_name("Q")
        ->check(load);
    command.add_option("--contact-deg", contact_deg, "Angle of the contact's centre [degrees]")
        ->required()
        ->type_name("A")
        ->check(angle);
    command.add_option("--width-m", width_m, "Width of the contact, an arc on the surface [m]; 0: line load")
        ->type_name("W")
        ->check(isFrom(0, 1));
    addList(command, "--at-deg", at_deg, "Angles to look at [degrees], separated by commas", angle)
        .type_name("a,b");
    command.add_option("--points", points, "Or: so many angles, evenly spread from 0")
        ->type_name("N")
        ->check(isWhole(1, kMostPoints));
  }
  CommonOptions common;
  double radius_m = 0;
  double normal_n_per_m = 0;
  double tangential_n_per_m = 0;
  double contact_deg = 0;
  double width_m = 0;
  std::vector<double> at_deg;
  int points = 0;
};

void requireFitting(const StrainOptions& options, const config::Finger& finger) {
  requireInRubber(options.radius_m, finger);
  const double girth_m = 2 * std::numbers::pi * finger.outer_radius_m;
  if (!(options.width_m >= 0 && options.width_m <= girth_m))
    throw Failure(ExitCode::kUsage, fmt::format("--width-m: {} m is not from 0 to the surface's {} m",
                                                options.width_m, girth_m));
  if (options.radius_m == finger.outer_radius_m && options.width_m == 0)
    throw Failure(ExitCode::kUsage,
                  "--radius-m: at the surface the field of a line load is a delta function; choose a smaller "
                  "radius or give --width-m");
  if (options.at_deg.empty() == (options.points == 0))
    throw Failure(ExitCode::kUsage, "give the angles: either --at-deg a,b,... or --points N");
}

std::vector<double> anglesOf(const StrainOptions& options) {
  if (options.points == 0) return options.at_deg;
  std::vector<double> angles_deg;
  for (int i = 0; i < options.points; ++i) angles_deg.push_back(i * 360.0 / options.points);
  return angles_deg;
}

/// Relative to the contact and within half a revolution before they become radians: what is close to the
/// contact keeps all its digits.
std::vector<double> relativeAngles(const std::vector<double>& angles_deg, double contact_deg) {
  std::vector<double> angles_rad;
  for (const double angle_deg : angles_deg)
    angles_rad.push_back(std::remainder(angle_deg - contact_deg, 360) * kRadPerDeg);
  return angles_rad;
}

void runStrain(const StrainOptions& options) {
  using namespace model;
  const config::Finger finger = options.common.config().finger;
  requireFitting(options, finger);
  const std::vector<double> angles_deg = anglesOf(options);
  const SurfaceLoad load{.normal_n_per_m = options.normal_n_per_m,
                         .tangential_n_per_m = options.tangential_n_per_m,
                         .width_rad = options.width_m / finger.outer_radius_m};
  constexpr std::array kRows{kErr, kEtt, kErt, kUr, kUt, kTrr, kTrt, kTtt};
  const Eigen::MatrixXd field = computeField(finger.annulus(), options.radius_m, load,
                                             relativeAngles(angles_deg, options.contact_deg), kRows);
  // At the edge of a load they are infinite, which says nothing of the others.
  const auto strains = field.leftCols<3>().array().abs();
  if (const double most = strains.isFinite().select(strains, 0).maxCoeff(); most > kMostLinearStrain)
    warn("strain", fmt::format("strains of up to {:.2g}: the model is for small ones", most));
  TableWriter table(stdout, options.common.format(),
                    {"angle_deg", "err", "ett", "ert", "ur_m", "ut_m", "trr_pa", "trt_pa", "ttt_pa"});
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    std::vector<Cell> cells{angles_deg[i]};
    for (const double value : field.row(static_cast<Eigen::Index>(i))) cells.emplace_back(value);
    table.row(cells);
  }
}

}  // namespace

void addStrain(CLI::App& app) { addCommand<StrainOptions>(app, "strain", kStrainHelp, runStrain); }

}  // namespace strainfinger::cli
