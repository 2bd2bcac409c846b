#include "host/contact/contact_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/base/failure.hpp"
#include "host/contact/overlap.hpp"
#include "host/contact/surface_motion.hpp"

namespace strainfinger::contact {
namespace {

/// Of the depth, without a warning: just below what the stability survey fails at (1e-6).
constexpr double kMostResidual = 9e-7;

/// Of the depth: what is farther off is no answer.
constexpr double kHopeless = 0.1;

/// Of the depth, without a warning: what the curve through measured points may swing by between them.
constexpr double kMostSwing = 0.01;

/// Of each patch, none of them a point of the solver's.
constexpr std::array kResidualPlaces{-0.999, -0.93, -0.71, -0.31, 0.13, 0.53, 0.83, 0.97};

/// Above the undeformed surface, for no approach.
double profileAt(const SurfaceKernel& kernel, const Indenter& indenter, double angle_rad) {
  const double x_m = kernel.annulus().outer_radius_m * angle_rad;
  return x_m * angle_rad / 2 + indenter.height(x_m);
}

bool pulls(const Tractions& tractions) {
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(201, -1, 1);
  double least = 0, most = 0;
  for (const PatchTractions& part : tractions) {
    const Eigen::ArrayXd pressures = part.pressure_pa({1 + x, 1 - x});
    least = std::min(least, pressures.minCoeff());
    most = std::max(most, pressures.maxCoeff());
  }
  return least < -1e-9 * most;
}

/// At the places where the residual is looked at.
double deepestOf(const SurfaceKernel& kernel, const Indenter& indenter, const Contact& contact) {
  double deepest_m = -std::numeric_limits<double>::infinity();
  for (const PatchTractions& part : contact.tractions)
    for (const double place : kResidualPlaces) {
      const double angle_rad = part.patch.centre_rad + place * part.patch.half_rad;
      deepest_m = std::max(deepest_m, contact.approach_m - profileAt(kernel, indenter, angle_rad));
    }
  return deepest_m;
}

void warnOfOverlaps(const SurfaceKernel& kernel, const Indenter& indenter, Contact& contact) {
  const double radius_m = kernel.annulus().outer_radius_m;
  const std::vector<Overlap> overlaps =
      findOverlaps(kernel, indenter, contact.tractions, contact.approach_m, 1e-12 + 2 * contact.residual_m);
  if (overlaps.empty()) return;
  const Overlap& worst = *std::ranges::max_element(overlaps, {}, &Overlap::depth_m);
  contact.warnings.push_back(
      fmt::format("the indenter is inside the rubber by {:.2g} m at {:.6g} m and {} places in all",
                  worst.depth_m, radius_m * worst.deepest_rad, overlaps.size()));
}

void doubtShape(const Indenter& indenter, double radius_m, double depth_m, Contact& contact) {
  const double first_rad = contact.tractions.front().patch.first_rad(),
               last_rad = contact.tractions.back().patch.last_rad();
  const Indenter::Swing swing = indenter.swing(radius_m * first_rad, radius_m * last_rad);
  if (swing.height_m <= kMostSwing * depth_m) return;
  const std::string what = fmt::format(
      "the measured heights jump or bend too sharply for their spacing near {:.6g} m: the smooth curve "
      "through them swings by {:.2g} m there, {:.2g} of the depth; measure more points there, or leave out "
      "what doesn't touch",
      swing.position_m, swing.height_m, swing.height_m / depth_m);
  if (swing.height_m > kHopeless * depth_m) throw Failure(ExitCode::kFailure, what);
  contact.warnings.push_back(what);
}

/// By how much of itself the load changes on the same patches if edges are resolved four times as finely.
double loadsDoubt(const SurfaceKernel& kernel, const ContactRequest& request, const Contact& contact) {
  std::vector<Patch> patches;
  for (const PatchTractions& part : contact.tractions) patches.push_back(part.patch);
  const PatchSolution finer = SpectralSolver(kernel, request.regime, 0, 2 * contact.terms)
                                  .solve(patches, request.indenter, request.tangential_n_per_m);
  const double load = kernel.annulus().outer_radius_m * totalTraction(finer.tractions).pressure_pa;
  return load / contact.normal_n_per_m - 1;
}

void doubtStick(const SurfaceKernel& kernel, const ContactRequest& request, Contact& contact) {
  constexpr double kMostDoubt = 0.1;
  const double doubt = loadsDoubt(kernel, request, contact);
  if (!(std::abs(doubt) <= kMostDoubt && contact.normal_n_per_m > 0))
    throw Failure(ExitCode::kFailure,
                  fmt::format("stick at nu = {:.3g} has no load of its own: its tractions oscillate at the "
                              "edges, and with twice the {} terms the load changes by {:.2g} %; ask for "
                              "--regime sliding or frictionless, or a nu nearer to 1/2",
                              kernel.annulus().poisson_ratio, contact.terms, 100 * doubt));
  contact.warnings.push_back(
      fmt::format("stick below nu = 1/2 is ill-posed: its tractions oscillate at the edges, and how finely "
                  "these are resolved decides the load: with twice the {} terms it changes by {:+.2g} %",
                  contact.terms, 100 * doubt));
}

}  // namespace

double residual(const SurfaceKernel& kernel, const Indenter& indenter, const Tractions& tractions,
                double approach_m, std::optional<double> shift_m) {
  const SurfaceMotion motion(kernel, tractions);
  double worst_m = 0;
  for (const PatchTractions& part : tractions)
    for (const double place : kResidualPlaces) {
      const double angle_rad = part.patch.centre_rad + place * part.patch.half_rad;
      const SurfacePoint point = motion.displacementAt(angle_rad);
      worst_m = std::max(worst_m, std::abs(point.ur_m - profileAt(kernel, indenter, angle_rad) + approach_m));
      if (shift_m) worst_m = std::max(worst_m, std::abs(point.ut_m - *shift_m));
    }
  return worst_m;
}

bool isIllPosed(const SurfaceKernel& kernel, const ContactRequest& request) {
  return kernel.annulus().poisson_ratio != 0.5 && request.regime == Regime::kStick;
}

void checkContact(const SurfaceKernel& kernel, const ContactRequest& request, Contact& contact) {
  std::vector<std::string>& warnings = contact.warnings;
  const bool sticks = request.regime == Regime::kStick;
  contact.residual_m = residual(kernel, request.indenter, contact.tractions, contact.approach_m,
                                sticks ? std::optional(contact.shift_m) : std::nullopt);
  contact.deepest_m = deepestOf(kernel, request.indenter, contact);
  const double depth_m = std::max(contact.deepest_m, std::abs(contact.approach_m));
  if (isIllPosed(kernel, request)) doubtStick(kernel, request, contact);
  if (request.centre_rad && contact.residual_m > kMostResidual * depth_m)
    warnings.emplace_back(
        "no contact with its centre held there fits this indenter: the tractions are those of an indenter "
        "that is turned by what the residual tells");
  else if (contact.residual_m > kHopeless * depth_m)
    throw Failure(
        ExitCode::kFailure,
        fmt::format("{} terms a patch leave {:.2g} of the depth unresolved: the contact is too wide for "
                    "so thin a layer, or its shape too rough; ask for less width or load, or for thicker "
                    "rubber",
                    contact.terms, contact.residual_m / depth_m));
  else if (!isIllPosed(kernel, request) && contact.residual_m > kMostResidual * depth_m)
    warnings.push_back(fmt::format("inaccurate: {} terms a patch leave {:.2g} of the depth unresolved",
                                   contact.terms, contact.residual_m / depth_m));
  doubtShape(request.indenter, kernel.annulus().outer_radius_m, depth_m, contact);
  if (request.indenter.isMeasured() && (request.centre_rad || isIllPosed(kernel, request)))
    warnOfOverlaps(kernel, request.indenter, contact);
  if (pulls(contact.tractions))
    warnings.emplace_back("the tractions pull somewhere: no contact is like this");
}

}  // namespace strainfinger::contact
