#include "host/contact/region_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/contact/overlap.hpp"

namespace strainfinger::contact {
namespace {

constexpr int kMostRounds = 24;
constexpr std::size_t kMostRegions = 16;
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

/// The regions that should be: the same ones if all is well.
std::vector<Patch> improved(const SurfaceKernel& kernel, const Indenter& indenter, const EdgeResult& found) {
  const Tractions& tractions = found.solution.tractions;
  const double largest_pa = largestPressure(tractions);
  std::vector<Patch> patches;
  for (const PatchTractions& part : tractions)
    if (part.smooth.integral() > 0) appendPushing(part, largest_pa, patches);
  if (!areSame(patches, found.patches)) return patches;
  for (const Overlap& overlap :
       findOverlaps(kernel, indenter, tractions, -found.solution.lift_m[0], kPenetration_m))
    patches.push_back({overlap.run.centre_rad, overlap.run.half_rad / 2});
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

}  // namespace

EdgeResult settleRegions(const SurfaceKernel& kernel, const SpectralSolver& solver,
                         const ContactRequest& request, std::vector<Patch> patches) {
  const EdgeSearch search(kernel, solver, request);
  EdgeResult found;
  for (int round = 0; round < kMostRounds; ++round) {
    requireFew(patches, kernel.annulus().outer_radius_m);
    found = search.run(patches);
    if (!found.areSettled) {
      patches = reduced(found.patches);
      continue;
    }
    patches = improved(kernel, request.indenter, found);
    if (areSame(patches, found.patches)) return found;
  }
  if (!found.areSettled)
    throw Failure(
        ExitCode::kFailure,
        "no contact found: regions of the measured shape keep growing into each other: smooth the profile");
  return found;
}

}  // namespace strainfinger::contact
