#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>

#include "host/base/failure.hpp"
#include "host/model/series.hpp"
#include "tests/stability/all_cores.hpp"
#include "tests/stability/survey.hpp"
#include "tests/stability/wide_field.hpp"

namespace strainfinger::stability {
namespace {

using namespace model;

constexpr double kVanishing = 1e-60;
constexpr std::array kFieldAlphas{0.01, 0.1, 0.5, 0.7, 0.85, 0.93, 0.97, 0.99, 0.999};
constexpr std::array kFieldPoissonRatios{0.0, 0.499999, 0.5};
constexpr std::array kWidths_rad{0.0, 1e-6, 1e-4, 1e-2, 0.15, std::numbers::pi / 2};

/// Of the rubber's thickness, from the surface down.
constexpr std::array kDepths{0.0, 0.01, 0.1, 0.5, 0.9, 1.0};

/// From so many harmonics on only a few widths and angles are looked at; from there on fewer Poisson's
/// ratios.
constexpr int kManyHarmonics = 10'000, kTooManyHarmonics = 100'000;

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

std::vector<Row> allRows() {
  std::vector<Row> rows;
  for (int row = 0; row < kRowCount; ++row) rows.push_back(static_cast<Row>(row));
  return rows;
}

/// The field of either load, one row an angle; nothing where it is refused.
std::optional<std::array<Eigen::MatrixXd, 2>> fieldsOf(const Annulus<double>& annulus, double radius_m,
                                                       double width_rad,
                                                       const std::vector<double>& angles_rad) {
  std::array<Eigen::MatrixXd, 2> fields;
  try {
    for (const Traction load : {kNormal, kTangential})
      fields[load] = computeField(annulus, radius_m,
                                  {.normal_n_per_m = load == kNormal ? 1.0 : 0.0,
                                   .tangential_n_per_m = load == kTangential ? 1.0 : 0.0,
                                   .width_rad = width_rad},
                                  angles_rad, allRows());
  } catch (const Failure&) {
    return std::nullopt;
  }
  return fields;
}

/// Against one exact value an angle.
void compare(Worst& worst, const std::array<Eigen::MatrixXd, 2>& fields,
             std::span<const WideField::Value> exact) {
  std::array<Wide, kRowCount> peaks{}, differences{};
  for (std::size_t k = 0; k < exact.size(); ++k)
    for (int row = 0; row < kRowCount; ++row)
      for (const Traction load : {kNormal, kTangential}) {
        const double value = fields[load](static_cast<Eigen::Index>(k), row);
        const auto i = static_cast<std::size_t>(row);
        peaks[i] = std::max(peaks[i], Wide(abs(exact[k](row, load))));
        ++worst.samples;
        worst.notFinite += std::isfinite(value) ? 0 : 1;
        if (std::isfinite(value))
          differences[i] = std::max(differences[i], Wide(abs(value - exact[k](row, load))));
      }
  for (const Row row : allRows()) {  // those that vanish (at the core) have to be zero
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
        if (harmonics <= mostHarmonics || mostHarmonics >= kMaxHarmonics)  // there it is to be refused
          depths.push_back({annulus, radius_m, depth, harmonics});
      }
  std::ranges::stable_sort(depths, std::greater<>(), &Depth::harmonics);  // the longest first: fewer wait
  return depths;
}

/// 100 digits take their time: of long sums only some are looked at.
bool isLeftOut(const Depth& depth, double width_rad, int mostHarmonics) {
  return depth.harmonics > mostHarmonics ||
         (depth.harmonics > kManyHarmonics && width_rad != kWidths_rad[1] &&
          width_rad != kWidths_rad.back()) ||
         (depth.harmonics > kTooManyHarmonics && depth.annulus.poisson_ratio < 0.5);
}

std::vector<FieldRegion> surveyDepth(const Depth& depth, int mostHarmonics) {
  struct Part {
    std::size_t region, first;
    std::array<Eigen::MatrixXd, 2> fields;
  };
  std::vector<FieldRegion> regions;
  std::vector<WideField::Place> places;
  std::vector<Part> parts;
  for (const double width_rad : kWidths_rad) {
    const double alpha = depth.annulus.core_radius_m / depth.annulus.outer_radius_m;
    const FieldRegion region{alpha, depth.annulus.poisson_ratio, width_rad, depth.depthOfRubber, {}, false};
    const std::vector<double> angles_rad = anglesFor(
        width_rad, 1 - depth.radius_m / depth.annulus.outer_radius_m, depth.harmonics > kManyHarmonics);
    const auto fields = fieldsOf(depth.annulus, depth.radius_m, width_rad, angles_rad);
    if (fields && isLeftOut(depth, width_rad, mostHarmonics)) continue;
    regions.push_back(region);
    regions.back().isRefused = !fields;
    if (!fields) continue;
    parts.push_back({regions.size() - 1, places.size(), *fields});
    for (const double angle_rad : angles_rad) places.push_back({width_rad, angle_rad});
  }
  if (places.empty()) return regions;
  const auto exact = WideField(depth.annulus, depth.radius_m).at(places);
  for (const Part& part : parts)
    compare(regions[part.region].worst, part.fields,
            std::span(exact).subspan(part.first, static_cast<std::size_t>(part.fields[0].rows())));
  return regions;
}

}  // namespace

std::vector<FieldRegion> surveyFields(int mostHarmonics) {
  const std::vector<Depth> depths = depthsUpTo(mostHarmonics);
  std::vector<std::vector<FieldRegion>> found(depths.size());
  forEachOnAllCores(depths.size(), [&](std::size_t i) { found[i] = surveyDepth(depths[i], mostHarmonics); });
  std::vector<FieldRegion> regions;
  for (const auto& some : found) regions.insert(regions.end(), some.begin(), some.end());
  std::ranges::stable_sort(regions, std::less<>(), [](const FieldRegion& region) {
    return std::tuple(region.alpha, region.poissonRatio, region.depthOfRubber);
  });
  return regions;
}

}  // namespace strainfinger::stability
