#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>

#include "tests/stability/survey.hpp"
#include "tests/stability/wide_field.hpp"

namespace strainfinger::stability {
namespace {

using namespace model;

constexpr double kVanishing = 1e-60;
constexpr double kOuterRadius_m = 12.7e-3, kShearModulus_pa = 8.3e4;
constexpr std::array kFieldAlphas{0.01, 0.1, 0.5, 0.7, 0.85, 0.93, 0.97, 0.99, 0.999};
constexpr std::array kFieldPoissonRatios{0.0, 0.499999, 0.5};
constexpr std::array kWidths_rad{0.0, 1e-6, 1e-4, 1e-2, 0.15, std::numbers::pi / 2};

/// Of the rubber's thickness, from the surface down.
constexpr std::array kDepths{0.0, 0.01, 0.1, 0.5, 0.9, 1.0};

/// From so many harmonics on only a few widths and angles are looked at: 100 digits take their time.
constexpr int kManyHarmonics = 10'000;

/// Close to the load, to its edges, and far from it.
std::vector<double> anglesFor(double width_rad, double depth, bool fewOnly) {
  if (fewOnly) return {0, width_rad * 0.4995, width_rad * 0.5005 + 0.7 * depth, 2};
  const double half = width_rad / 2;
  std::vector<double> angles_rad{0, 0.01, 0.1, -1, 2, std::numbers::pi};
  for (const double part : {0.3, -0.9, 0.999, 1.001, 1.1, -3.0})
    if (half > 0 && std::abs(part) * half < std::numbers::pi) angles_rad.push_back(part * half);
  for (const double depths : {-0.4, 0.7, 1.5})
    if (depth > 0) angles_rad.push_back(half + depths * depth);
  return angles_rad;
}

void compare(Worst& worst, const WideField& exact, const FieldRegion& region, const Annulus<double>& annulus,
             double radius_m) {
  std::array<Row, kRowCount> rows;
  for (int row = 0; row < kRowCount; ++row) rows[static_cast<std::size_t>(row)] = static_cast<Row>(row);
  const std::vector<double> angles_rad = anglesFor(region.width_rad, 1 - radius_m / annulus.outer_radius_m,
                                                   WideField::harmonics(annulus, radius_m) > kManyHarmonics);
  std::array<Eigen::MatrixXd, 2> fields;
  for (const Traction load : {kNormal, kTangential})
    fields[load] = computeField(annulus, radius_m,
                                {.normal_n_per_m = load == kNormal ? 1.0 : 0.0,
                                 .tangential_n_per_m = load == kTangential ? 1.0 : 0.0,
                                 .width_rad = region.width_rad},
                                angles_rad, rows);
  std::array<Wide, kRowCount> peaks{}, differences{};
  for (std::size_t k = 0; k < angles_rad.size(); ++k) {
    const auto known = exact.at(region.width_rad, angles_rad[k]);
    for (int row = 0; row < kRowCount; ++row)
      for (const Traction load : {kNormal, kTangential}) {
        const double value = fields[load](static_cast<Eigen::Index>(k), row);
        const auto i = static_cast<std::size_t>(row);
        peaks[i] = std::max(peaks[i], Wide(abs(known(row, load))));
        ++worst.samples;
        worst.notFinite += std::isfinite(value) ? 0 : 1;
        if (std::isfinite(value))
          differences[i] = std::max(differences[i], Wide(abs(value - known(row, load))));
      }
  }
  for (const Row row : rows) {  // those that vanish (at the core) have to be zero
    const double other = differences[row] < kVanishing ? 0 : double{INFINITY};
    worst.take(row, peaks[row] > kVanishing ? static_cast<double>(differences[row] / peaks[row]) : other);
  }
}

/// A depth in one finger, and how many harmonics it takes.
struct Depth {
  Annulus<double> annulus;
  double radius_m, depthOfRubber;
  int harmonics;
};

std::vector<Depth> depthsUpTo(int mostHarmonics) {
  std::vector<Depth> depths;
  for (const double alpha : kFieldAlphas)
    for (const double poissonRatio : kFieldPoissonRatios)
      for (const double depth : kDepths) {
        const double core_m = alpha * kOuterRadius_m, rubber_m = kOuterRadius_m - core_m;
        const double radius_m = depth == 1 ? core_m : kOuterRadius_m - depth * rubber_m;
        const Annulus<double> annulus{core_m, kOuterRadius_m, kShearModulus_pa, poissonRatio};
        const int harmonics = WideField::harmonics(annulus, radius_m);
        if (harmonics <= mostHarmonics) depths.push_back({annulus, radius_m, depth, harmonics});
      }
  return depths;
}

std::vector<FieldRegion> surveyDepth(const Depth& depth) {
  const WideField exact(depth.annulus, depth.radius_m);
  std::vector<FieldRegion> regions;
  for (const double width_rad : kWidths_rad) {
    const bool isRefused = depth.depthOfRubber == 0 && width_rad == 0;  // a delta function
    const bool isLeftOut =
        depth.harmonics > kManyHarmonics && width_rad != kWidths_rad[1] && width_rad != kWidths_rad.back();
    if (isRefused || isLeftOut) continue;
    const double alpha = depth.annulus.core_radius_m / depth.annulus.outer_radius_m;
    regions.push_back({alpha, depth.annulus.poisson_ratio, width_rad, depth.depthOfRubber, {}});
    compare(regions.back().worst, exact, regions.back(), depth.annulus, depth.radius_m);
  }
  return regions;
}

}  // namespace

std::vector<FieldRegion> surveyFields(int mostHarmonics) {
  const std::vector<Depth> depths = depthsUpTo(mostHarmonics);
  std::vector<std::vector<FieldRegion>> found(depths.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < depths.size(); i = next++) found[i] = surveyDepth(depths[i]);
  };
  {
    std::vector<std::jthread> workers;
    for (unsigned i = 1; i < std::thread::hardware_concurrency(); ++i) workers.emplace_back(work);
    work();
  }
  std::vector<FieldRegion> regions;
  for (const auto& some : found) regions.insert(regions.end(), some.begin(), some.end());
  return regions;
}

}  // namespace strainfinger::stability
