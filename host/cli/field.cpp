#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/contact_options.hpp"
#include "host/cli/model_options.hpp"
#include "host/contact/contact_field.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kFieldHelp =
    "Strains, displacements and stresses in the rubber under an indenter, on a polar grid: even radii "
    "from the core to the surface, or the radius of --radius-m (that of the gauges, say), and even angles "
    "from the indenter's normal. The load of a line or of a uniform pressure is for `strain`.\n"
    "Prints radius_m,angle_deg,err,ett,ert,ur_m,ut_m,trr_pa,trt_pa,ttt_pa: strains e (radial, hoop, shear), "
    "displacements u, stresses t; angles from the indenter's normal.";

struct FieldOptions {
  explicit FieldOptions(CLI::App& command) : common(command), contact(command) {
    const auto count = isWhole(2, 10'000);
    auto* const grid = command
                           .add_option("--radii", radii,
                                       fmt::format("Number of radii, core and surface included ({})", radii))
                           ->check(count);
    command.add_option("--radius-m", radius_m, "Or: this radius alone [m]")->type_name("R")->excludes(grid);
    command.add_option("--angles", angles, fmt::format("Number of angles ({})", angles))->check(count);
    const auto angle = isFrom(-180, 180);
    command.add_option("--from-deg", from_deg, "First angle [degrees]")->capture_default_str()->check(angle);
    command.add_option("--to-deg", to_deg, "Last angle [degrees]")->capture_default_str()->check(angle);
  }
  CommonOptions common;
  ContactOptions contact;
  int radii = 20;
  std::optional<double> radius_m;
  int angles = 81;
  double from_deg = -20;
  double to_deg = 20;
};

/// Between that depth and the surface the field needs too many harmonics.
double leastDepth_m(const model::Annulus<double>& annulus) {
  return annulus.outer_radius_m - contact::fieldLimit_m(annulus);
}

/// Of radii evenly from the core to the surface the last but one is the closest to the surface.
void requireDeep(int radii, const model::Annulus<double>& annulus) {
  const double layer_m = annulus.outer_radius_m - annulus.core_radius_m, least_m = leastDepth_m(annulus);
  const int most = std::max(2, static_cast<int>(std::ceil(layer_m / least_m)));
  if (radii <= most) return;
  throw Failure(
      ExitCode::kUsage,
      fmt::format("--radii {}: the last radius below the surface would be closer to it than {:.2g} m, "
                  "where the field needs too many harmonics; at most {} in this finger",
                  radii, least_m, most));
}

std::vector<double> radiiOf(const FieldOptions& options, const config::Finger& finger) {
  const model::Annulus<double> annulus = finger.annulus();
  if (!options.radius_m) {
    requireDeep(options.radii, annulus);
    return evenly(annulus.core_radius_m, annulus.outer_radius_m, options.radii);
  }
  const double radius_m = *options.radius_m;
  requireInRubber(radius_m, finger);
  if (radius_m > contact::fieldLimit_m(annulus) && radius_m < annulus.outer_radius_m)
    throw Failure(
        ExitCode::kUsage,
        fmt::format("--radius-m {}: closer to the surface than {:.2g} m, where the field needs too many "
                    "harmonics; the surface itself needs none",
                    radius_m, leastDepth_m(annulus)));
  return {radius_m};
}

void runField(const FieldOptions& options) {
  using namespace model;
  const config::FingerConfig config = options.common.config();
  const std::vector<double> radii_m = radiiOf(options, config.finger);
  const contact::SurfaceKernel kernel(config.finger.annulus());
  const contact::ContactRequest request = options.contact.request(config);
  const contact::Contact contact = contact::solveContact(kernel, request);
  tellOf("field", contact, request, config);
  constexpr std::array kRows{kErr, kEtt, kErt, kUr, kUt, kTrr, kTrt, kTtt};
  const std::vector<double> angles_rad =
      evenly(options.from_deg * kRadPerDeg, options.to_deg * kRadPerDeg, options.angles);
  TableWriter table(
      stdout, options.common.format(),
      {"radius_m", "angle_deg", "err", "ett", "ert", "ur_m", "ut_m", "trr_pa", "trt_pa", "ttt_pa"});
  for (const double radius_m : radii_m) {
    const auto field = contact::computeContactField(kernel, contact.tractions, radius_m, angles_rad, kRows);
    for (std::size_t k = 0; k < angles_rad.size(); ++k) {
      std::vector<Cell> cells{radius_m, angles_rad[k] / kRadPerDeg};
      for (const double value : field.row(static_cast<Eigen::Index>(k))) cells.emplace_back(value);
      table.row(cells);
    }
  }
}

}  // namespace

void addField(CLI::App& app) { addCommand<FieldOptions>(app, "field", kFieldHelp, runField); }

}  // namespace strainfinger::cli
