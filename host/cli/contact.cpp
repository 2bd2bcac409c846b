#include "host/contact/contact.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/failure.hpp"
#include "host/cli/command.hpp"
#include "host/cli/commands.hpp"
#include "host/cli/contact_options.hpp"
#include "host/cli/model_options.hpp"
#include "host/contact/surface_motion.hpp"

namespace strainfinger::cli {
namespace {

constexpr const char* kHelp =
    "What an indenter and the finger exert on each other: pressure (positive when pressing), shear (positive "
    "towards +theta) and the slope d u_r / d theta [m/rad] of the surface, against the angle from the "
    "indenter's normal.\n"
    "Where they touch, u_r = -approach + x^2 / 2 r_b + height(x), x = r_b theta: the paper's convention, in "
    "which "
    "a flat indenter's slope is r_b theta. How far the answer, recomputed from its tractions, is from that "
    "is "
    "the residual, told on stderr.";

constexpr double kDegree = std::numbers::pi / 180;

struct ContactCommand {
  explicit ContactCommand(CLI::App& command) : common(command), contact(command) {
    command.add_flag("--summary", summary, "Loads, width, depth, offset and residual only, as one row");
    auto& list =
        *command
             .add_option("--at-deg", at_deg,
                         "Angles to look at, from the indenter's normal [degrees], separated by commas")
             ->type_name("a,b")
             ->delimiter(',')
             ->check(realFrom(-180, 180));
    command.add_option("--points", points, "Or: so many, evenly over twice the contact's width (400)")
        ->type_name("N")
        ->check(CLI::Range(1, 1'000'000))
        ->excludes(&list);
  }
  CommonOptions common;
  ContactOptions contact;
  bool summary = false;
  std::vector<double> at_deg;
  int points = 400;
};

/// In the middle of `points` equal parts of twice the contact.
std::vector<double> anglesOf(const ContactCommand& options, const contact::Contact& contact,
                             double radius_m) {
  std::vector<double> angles_rad;
  for (const double angle_deg : options.at_deg) angles_rad.push_back(angle_deg * kDegree);
  const double width_rad = contact.width_m / radius_m;
  for (int i = 0; i < options.points && options.at_deg.empty(); ++i)
    angles_rad.push_back(contact.offset_rad + width_rad * (2 * (i + 0.5) / options.points - 1));
  return angles_rad;
}

void printSummary(const ContactCommand& options, const contact::Contact& contact) {
  TableWriter table(
      stdout, options.common.format(),
      {"normal_n_per_m", "tangential_n_per_m", "width_m", "depth_m", "offset_deg", "residual_m"});
  table.row({contact.normal_n_per_m, contact.tangential_n_per_m, contact.width_m, contact.depth_m,
             contact.offset_rad / kDegree, contact.residual_m});
}

void printTractions(const ContactCommand& options, const contact::SurfaceKernel& kernel,
                    const contact::Contact& contact) {
  const contact::SurfaceMotion motion(kernel, contact.tractions);
  TableWriter table(stdout, options.common.format(), {"angle_deg", "pressure_pa", "shear_pa", "slope"});
  for (const double angle_rad : anglesOf(options, contact, kernel.annulus().outer_radius_m)) {
    const contact::Traction traction = contact::tractionAt(contact.tractions, angle_rad);
    table.row({angle_rad / kDegree, traction.pressure_pa, traction.shear_pa, motion.at(angle_rad).urSlope_m});
  }
}

void runContact(const ContactCommand& options) {
  const config::FingerConfig config = options.common.config();
  const contact::SurfaceKernel kernel(config.finger.annulus());
  const contact::Contact contact = contact::solveContact(kernel, options.contact.request(config));
  fmt::print(stderr, "contact: residual {:.2g} m, recomputed from the tractions; {} terms a patch\n",
             contact.residual_m, contact.terms);
  for (const std::string& warning : contact.warnings) fmt::print(stderr, "contact: warning: {}\n", warning);
  if (options.summary)
    printSummary(options, contact);
  else
    printTractions(options, kernel, contact);
}

}  // namespace

void addContact(CLI::App& app) { addCommand<ContactCommand>(app, "contact", kHelp, runContact); }

}  // namespace strainfinger::cli
