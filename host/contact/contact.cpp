#include "host/contact/contact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/contact/contact_check.hpp"
#include "host/contact/contact_regions.hpp"
#include "host/contact/region_search.hpp"

namespace strainfinger::contact {
namespace {

/// [thicknesses of the rubber] The widest half contact for which answers are looked for: 160 terms leave 0.03
/// of its depth unresolved at 50 and more than a tenth here; the search takes minutes beyond this.
constexpr double kMostLayers = 100, kFirstLayers = 20;

double layer_rad(const model::Annulus<double>& annulus) {
  return 1 - annulus.core_radius_m / annulus.outer_radius_m;
}

void requireDomain(const SurfaceKernel& kernel, const ContactRequest& request) {
  const auto require = [](bool is, const std::string& what) {
    if (!is) throw Failure(ExitCode::kUsage, what);
  };
  const double value = request.size.value, widest_m = kWidestContact_rad * kernel.annulus().outer_radius_m;
  const bool isWidth = request.size.kind == ContactSize::Kind::kWidth;
  if (isWidth)
    require(value > 0 && value <= widest_m,
            fmt::format("the width must be above 0 and at most half the surface, {} m", widest_m));
  else
    require(value > 0 && std::isfinite(value), "the load must be a positive number");
  require(std::abs(request.friction) <= 10, "the coefficient of friction must be from -10 to 10");
  if (isWidth && value > 2 * kMostLayers * layer_rad(kernel.annulus()) * kernel.annulus().outer_radius_m)
    throw Failure(
        ExitCode::kFailure,
        fmt::format(
            "a contact {} m wide is too wide for so thin a layer: ask for less width, or for thicker rubber",
            value));
}

/// A contact by Hertz on a half plane, P = pi E* a^2 / 4 R + E* slope a, at most the widest;
/// in a thin layer the same load needs far less.
struct HertzContact {
  double half_rad;
  double exponent;  ///< d ln P / d ln a

  HertzContact(const model::Annulus<double>& annulus, const Indenter& indenter, double load_n_per_m) {
    const double radius_m = annulus.outer_radius_m, probe_m = 1e-4 * radius_m;
    const double modulus_pa = 2 * annulus.shear_modulus_pa / (1 - annulus.poisson_ratio);
    const double slope = indenter.edgeSlope();
    const double curvature_per_m = 1 / radius_m + (indenter.slope(probe_m) - slope) / probe_m;
    const double square = std::numbers::pi * modulus_pa * curvature_per_m / 4, linear = modulus_pa * slope;
    const double half_m =
        2 * load_n_per_m / (linear + std::sqrt(linear * linear + 4 * square * load_n_per_m));
    half_rad = std::min({half_m / radius_m, kWidestContact_rad / 2, kFirstLayers * layer_rad(annulus)});
    exponent = 1 + square * half_m * half_m / load_n_per_m;
  }
};

EdgeResult firstGuess(const SurfaceKernel& kernel, const ContactRequest& request) {
  if (request.indenter.isMeasured() && !request.centre_rad)
    return {findRegions(kernel, request.indenter, request.size), {}};
  const double centre_rad = request.centre_rad.value_or(0);
  if (request.size.kind == ContactSize::Kind::kWidth)
    return {{{centre_rad, request.size.value / (2 * kernel.annulus().outer_radius_m)}}, {}};
  const HertzContact hertz(kernel.annulus(), request.indenter, request.size.value);
  EdgeResult guess{{{centre_rad, hertz.half_rad}}, {}};
  guess.jacobian = Eigen::MatrixXd::Constant(1, 1, hertz.exponent);
  return guess;
}

bool isSmooth(const SurfaceKernel& kernel, const Indenter& indenter) {
  return kernel.annulus().poisson_ratio == 0.5 && !indenter.isMeasured();
}

/// Enough for 1e-12 of what is smooth and 1e-6 of what is not: the pressure follows the layer's depth. What
/// is ill-posed gets no more than that.
int termsFor(const SurfaceKernel& kernel, const ContactRequest& request, const std::vector<Patch>& patches) {
  const bool isOpen = isIllPosed(kernel, request), isMore = !isOpen && !isSmooth(kernel, request.indenter);
  if (!isOpen && request.indenter.isMeasured()) return kMeasuredTerms;
  double half_rad = 0;
  for (const Patch& patch : patches) half_rad = std::max(half_rad, patch.half_rad);
  return std::min(kMostTerms,
                  (isMore ? 24 : 12) + static_cast<int>(8 * half_rad / layer_rad(kernel.annulus())));
}

EdgeResult settled(const SurfaceKernel& kernel, const SpectralSolver& solver, const ContactRequest& request,
                   const EdgeResult& guess) {
  EdgeResult result = EdgeSearch(kernel, solver, request).run(guess.patches, guess.jacobian);
  if (result.outcome != EdgeResult::Outcome::kSettled)
    throw Failure(ExitCode::kFailure, "no contact found: no edges fit this indenter at this load or width");
  return result;
}

EdgeResult searchRegions(const SurfaceKernel& kernel, const ContactRequest& request, int& terms) {
  if (const std::optional<EdgeResult> plain = settlePlainRegion(kernel, request, terms)) return *plain;
  return settleRegions(kernel, request, findRegions(kernel, request.indenter, request.size), terms);
}

EdgeResult searchEdges(const SurfaceKernel& kernel, const ContactRequest& request, int& terms) {
  if (request.indenter.isMeasured() && !request.centre_rad && !isIllPosed(kernel, request))
    return searchRegions(kernel, request, terms);
  EdgeResult guess = firstGuess(kernel, request);
  for (terms = termsFor(kernel, request, guess.patches);; terms = std::min(2 * terms, kMostTerms)) {
    const SpectralSolver solver(kernel, request.regime, request.friction, terms);
    EdgeResult result = settled(kernel, solver, request, guess);
    const bool isWorthMore = isSmooth(kernel, request.indenter) && terms < kMostTerms;
    if (!isWorthMore || result.solution.tail() < kConverged) return result;
    guess = std::move(result);
  }
}

}  // namespace

Contact solveContact(const SurfaceKernel& kernel, const ContactRequest& request) {
  requireDomain(kernel, request);
  Contact contact;
  const EdgeResult found = searchEdges(kernel, request, contact.terms);
  const double radius_m = kernel.annulus().outer_radius_m;
  const double first_rad = found.patches.front().first_rad(), last_rad = found.patches.back().last_rad();
  const Traction total = totalTraction(found.solution.tractions);
  contact.tractions = found.solution.tractions;
  contact.normal_n_per_m = radius_m * total.pressure_pa;
  contact.tangential_n_per_m = radius_m * total.shear_pa;
  contact.width_m = radius_m * (last_rad - first_rad);
  contact.offset_rad = (first_rad + last_rad) / 2;
  contact.approach_m = -found.solution.lift_m[0];
  contact.depth_m = contact.approach_m - radius_m * contact.offset_rad * contact.offset_rad / 2 -
                    request.indenter.height(radius_m * contact.offset_rad);
  contact.shift_m = found.solution.shift_m;
  checkContact(kernel, request, contact);
  return contact;
}

}  // namespace strainfinger::contact
