#include "host/contact/region_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/contact/contact_check.hpp"
#include "host/contact/contact_regions.hpp"
#include "host/contact/overlap.hpp"

namespace strainfinger::contact {
namespace {

constexpr int kFewTerms = 24;               // that a smooth shape needs
constexpr double kConvergedRegions = 1e-7;  // of the last coefficients, with many terms
constexpr int kMostRounds = 10;
constexpr int kMostLost = 2;
constexpr std::size_t kMostRegions = 16;
constexpr std::size_t kFewRegions = 2;  // that get the most terms, in seconds
constexpr double kPenetration_m = 1e-12;
constexpr double kPull = 1e-9;       // of the largest pressure
constexpr double kVanishing = 1e-7;  // half width of a region, of the whole contact's width

void requireFew(const std::vector<Patch>& patches, double radius_m) {
  if (patches.size() > kMostRegions)
    throw Failure(
        ExitCode::kFailure,
        fmt::format("the measured shape touches in more than {} regions between {:.4g} and {:.4g} m: if that "
                    "is noise of the measurement, smooth the profile",
                    kMostRegions, radius_m * patches.front().first_rad(),
                    radius_m * patches.back().last_rad()));
}

/// What is left of a patch where its pressure pushes.
void appendPushing(const PatchTractions& part, double largest_pa, std::vector<Patch>& patches) {
  const Eigen::Index count = 4 * part.smooth.coefficients.size();
  const Eigen::ArrayXd x =
      -Eigen::ArrayXd::LinSpaced(count, 0.5, static_cast<double>(count) - 0.5).unaryExpr([&](double i) {
        return std::cos(std::numbers::pi * i / static_cast<double>(count));
      });
  const Eigen::ArrayXd pressures = part.pressure_pa({1 + x, 1 - x});
  if (pressures.minCoeff() >= -kPull * largest_pa) return patches.push_back(part.patch);
  double first = -1;
  const auto end = [&](double last) {
    const Patch& patch = part.patch;
    if (last > first)
      patches.push_back(
          {patch.centre_rad + patch.half_rad * (first + last) / 2, patch.half_rad * (last - first) / 2});
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    if (pressures[i] > 0) continue;
    if (i > 0 && pressures[i - 1] > 0) end((x[i - 1] + x[i]) / 2);
    first = i + 1 < count ? (x[i] + x[i + 1]) / 2 : 1;
  }
  if (pressures[count - 1] > 0) end(1);
}

double largestPressure(const Tractions& tractions) {
  double largest_pa = 0;
  const Eigen::ArrayXd x = Eigen::ArrayXd::LinSpaced(65, -1, 1);
  for (const PatchTractions& part : tractions)
    largest_pa = std::max(largest_pa, part.pressure_pa({1 + x, 1 - x}).maxCoeff());
  return largest_pa;
}

bool areSame(const std::vector<Patch>& some, const std::vector<Patch>& others) {
  return std::ranges::equal(some, others, {}, &Patch::half_rad, &Patch::half_rad);
}

/// Edges that come back although what pulled beside them was cut off: a series' ringing, nothing that pulls.
bool comeBack(const std::vector<Patch>& some, const std::vector<Patch>& others) {
  constexpr double kAlike = 1e-3;  // of a half width: ringing spans the last hundredth of it
  return std::ranges::equal(some, others, [](const Patch& one, const Patch& other) {
    return std::abs(one.first_rad() - other.first_rad()) < kAlike * one.half_rad &&
           std::abs(one.last_rad() - other.last_rad()) < kAlike * one.half_rad;
  });
}

/// What penetrates by more than it may and more than the surface is off within the regions.
std::vector<Overlap> overlapsOf(const SurfaceKernel& kernel, const ContactRequest& request,
                                const EdgeResult& found) {
  const double approach_m = -found.solution.lift_m[0];
  const double tolerance_m =
      kPenetration_m + 2 * residual(kernel, request.indenter, found.solution.tractions, approach_m);
  return findOverlaps(kernel, request.indenter, found.solution.tractions, approach_m, tolerance_m);
}

/// What is left of the patches where their pressures push.
std::vector<Patch> pushing(const Tractions& tractions) {
  const double largest_pa = largestPressure(tractions);
  std::vector<Patch> patches;
  for (const PatchTractions& part : tractions)
    if (part.smooth.integral() > 0) appendPushing(part, largest_pa, patches);
  return patches;
}

/// The regions that should be: the same ones if all is well.
std::vector<Patch> improved(const SurfaceKernel& kernel, const ContactRequest& request,
                            const EdgeResult& found) {
  std::vector<Patch> patches = pushing(found.solution.tractions);
  if (!areSame(patches, found.patches)) return patches;
  for (const Overlap& overlap : overlapsOf(kernel, request, found)) {
    const bool isBeside = overlap.deepest_rad < found.patches.front().first_rad() ||
                          overlap.deepest_rad > found.patches.back().last_rad();
    if (isBeside && request.size.kind == ContactSize::Kind::kWidth)
      throw Failure(
          ExitCode::kFailure,
          fmt::format("no load makes a contact {} m wide: the shape touches at {:.6g} m too then, and its "
                      "width jumps; give --load-n-per-m",
                      request.size.value, kernel.annulus().outer_radius_m * overlap.deepest_rad));
    patches.push_back({overlap.run.centre_rad, overlap.run.half_rad / 2});
  }
  std::ranges::sort(patches, {}, &Patch::centre_rad);
  return patches;
}

/// Without the region that all but vanished, or else with the two that are closest as one.
std::vector<Patch> reduced(std::vector<Patch> patches) {
  const auto smallest = std::ranges::min_element(patches, {}, &Patch::half_rad);
  if (smallest->half_rad < kVanishing * (patches.back().last_rad() - patches.front().first_rad())) {
    patches.erase(smallest);
    return patches;
  }
  std::size_t closest = 1;
  const auto distance = [&](std::size_t k) { return patches[k].first_rad() - patches[k - 1].last_rad(); };
  for (std::size_t k = 2; k < patches.size(); ++k)
    if (distance(k) < distance(closest)) closest = k;
  const double first_rad = patches[closest - 1].first_rad(), last_rad = patches[closest].last_rad();
  patches[closest - 1] = {(first_rad + last_rad) / 2, (last_rad - first_rad) / 2};
  patches.erase(patches.begin() + static_cast<std::ptrdiff_t>(closest));
  return patches;
}

[[noreturn]] void throwUnsettled(const std::vector<Patch>& patches, const ContactRequest& request,
                                 double radius_m) {
  const Patch& narrowest = *std::ranges::min_element(patches, {}, &Patch::half_rad);
  throw Failure(
      ExitCode::kFailure,
      fmt::format(
          "no contact found: regions of the measured shape don't settle, the narrowest about {:.6g} m, "
          "{:.2g} m wide; if that is noise of the measurement, smooth the profile{}",
          radius_m * narrowest.centre_rad, 2 * radius_m * narrowest.half_rad,
          request.size.kind == ContactSize::Kind::kWidth
              ? "; if not, its width may jump over the one asked for: give --load-n-per-m"
              : ""));
}

/// Rounds until the regions stay the same; if they don't, the outcome is not kSettled.
EdgeResult settleOnce(const SurfaceKernel& kernel, const SpectralSolver& solver,
                      const ContactRequest& request, std::vector<Patch> patches) {
  using Outcome = EdgeResult::Outcome;
  const EdgeSearch search(kernel, solver, request);
  EdgeResult found{patches, {}, Outcome::kLost}, before{{}, {}, Outcome::kLost};
  for (int round = 0, lost = 0; round < kMostRounds && !patches.empty() && lost < kMostLost; ++round) {
    if (patches.size() > kFewRegions && solver.terms() > kMeasuredTerms) break;
    requireFew(patches, kernel.annulus().outer_radius_m);
    found = search.run(patches);
    if (found.outcome == Outcome::kSettled) {
      patches = improved(kernel, request, found);
      if (areSame(patches, found.patches)) return found;
      if (comeBack(before.patches, found.patches) && overlapsOf(kernel, request, before).empty())
        return before;
      before = found;
    } else if (found.outcome == Outcome::kCollide) {
      patches = reduced(found.patches);
    } else {
      if (patches.size() == 1) break;
      patches.erase(
          std::ranges::min_element(patches, {}, &Patch::half_rad));  // comes again if it has to touch
      ++lost;
    }
  }
  found.outcome = Outcome::kLost;
  return found;
}

}  // namespace

std::optional<EdgeResult> settlePlainRegion(const SurfaceKernel& kernel, const ContactRequest& request,
                                            int& terms) {
  EdgeResult found{{guessRegion(kernel, request.indenter, request.size)}, {}};
  try {
    for (terms = 16; terms <= kMeasuredTerms; terms *= 2) {
      const SpectralSolver solver(kernel, request.regime, request.friction, terms);
      found = EdgeSearch(kernel, solver, request).run(found.patches, found.jacobian);
      if (found.outcome != EdgeResult::Outcome::kSettled) return {};
      if (found.solution.tail() < (terms < kMeasuredTerms ? kConverged : kConvergedRegions)) break;
    }
  } catch (const Failure&) {  // beyond the shape: the search of all regions tells, if it fails too
    return {};
  }
  const bool isContact = terms <= kMeasuredTerms &&
                         areSame(pushing(found.solution.tractions), found.patches) &&
                         overlapsOf(kernel, request, found).empty();
  return isContact ? std::optional(found) : std::nullopt;
}

EdgeResult settleRegions(const SurfaceKernel& kernel, const ContactRequest& request,
                         std::vector<Patch> patches, int& terms) {
  terms = kFewTerms;
  EdgeResult best =
      settleOnce(kernel, SpectralSolver(kernel, request.regime, request.friction, terms), request, patches);
  if (best.outcome == EdgeResult::Outcome::kSettled) {
    if (best.solution.tail() < kConverged) return best;
    patches = best.patches;
  }
  double least_m = std::numeric_limits<double>::infinity();
  for (const int more : {kMeasuredTerms, kMostTerms}) {
    const SpectralSolver solver(kernel, request.regime, request.friction, more);
    EdgeResult found = settleOnce(kernel, solver, request, patches);
    const bool isSettled = found.outcome == EdgeResult::Outcome::kSettled;
    if (!isSettled && std::isfinite(least_m)) break;
    const double misfit_m =
        isSettled ? residual(kernel, request.indenter, found.solution.tractions, -found.solution.lift_m[0])
                  : least_m;
    if (isSettled && misfit_m > least_m) break;  // a kink rings the more, the more terms
    best = std::move(found);
    terms = more;
    least_m = misfit_m;
    if (!isSettled) continue;
    if (best.patches.size() > kFewRegions || least_m < kPenetration_m) break;
    if (best.patches.size() == 1 && best.solution.tail() < kConvergedRegions) break;
    patches = best.patches;
  }
  if (best.outcome != EdgeResult::Outcome::kSettled)
    throwUnsettled(best.patches, request, kernel.annulus().outer_radius_m);
  return best;
}

}  // namespace strainfinger::contact
