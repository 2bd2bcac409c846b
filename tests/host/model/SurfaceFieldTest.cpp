#include "host/model/surface_field.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/model/field.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::model;
using namespace strainfinger::testing;

namespace {

constexpr std::array kSurfaceRows{kTrr, kTrt, kTtt, kUr, kUt, kErr, kEtt, kErt};
constexpr std::array kSurfaceAngles_rad{0.0, 0.03, -0.05, 0.12, 0.2, -1.0, 2.5, std::numbers::pi};
constexpr double kWidth_rad = 0.15;
constexpr SurfaceLoad kLoad{.normal_n_per_m = 3, .tangential_n_per_m = 2, .width_rad = kWidth_rad};

double at(const Annulus<double>& finger, const SurfaceLoad& load, double angle_rad, Row row) {
  return computeSurfaceField(finger, load, std::array{angle_rad}, std::array{row})(0, 0);
}

/// The series itself, its end smoothed by an exponential filter: away from the jumps that converges faster
/// than any power, to rounding here.
class FilteredSeries {
 public:
  FilteredSeries(const Annulus<double>& finger, const SurfaceLoad& load) {
    const HarmonicModel<double> surface(finger, finger.outer_radius_m);
    const double unit = 1 / (std::numbers::pi * finger.outer_radius_m);
    for (int n = 0; n <= kLast; ++n) {
      const double half = n * load.width_rad / 2, mean = n == 0 ? 0.5 : std::sin(half) / half;
      const double weight = unit * mean * std::exp(-36 * std::pow(n / double{kLast}, 8));
      terms_.push_back(surface(n));
      terms_.back().col(kNormal) *= -load.normal_n_per_m * weight;
      terms_.back().col(kTangential) *= load.tangential_n_per_m * weight;
    }
  }

  std::array<double, kRowCount> at(double angle_rad) const {
    std::array<double, kRowCount> sums{};
    for (int n = 0; n <= kLast; ++n) {
      const auto& term = terms_[static_cast<std::size_t>(n)];
      const double c = std::cos(n * angle_rad), s = std::sin(n * angle_rad);
      for (const Row row : kSurfaceRows) {
        const bool isShear = row == kTrt || row == kUt || row == kErt;
        sums[row] += isShear ? term(row, kTangential) * c - term(row, kNormal) * s
                             : term(row, kNormal) * c + term(row, kTangential) * s;
      }
    }
    return sums;
  }

 private:
  static constexpr int kLast = 20000;
  std::vector<HarmonicResponse<double>> terms_;
};

void checkAgainstFilteredSums(const Annulus<double>& finger) {
  const Eigen::MatrixXd field = computeSurfaceField(finger, kLoad, kSurfaceAngles_rad, kSurfaceRows);
  const FilteredSeries series(finger, kLoad);
  for (Eigen::Index k = 0; k < field.rows(); ++k) {
    const auto known = series.at(kSurfaceAngles_rad[static_cast<std::size_t>(k)]);
    for (Eigen::Index i = 0; i < field.cols(); ++i)
      DOUBLES_EQUAL(known[kSurfaceRows[static_cast<std::size_t>(i)]], field(k, i),
                    1e-11 * field.col(i).cwiseAbs().maxCoeff());
  }
}

}  // namespace

TEST_GROUP(SurfaceField) {};

TEST(SurfaceField, AgreesWithFilteredSums) {
  checkAgainstFilteredSums(kDefaultFinger);
  checkAgainstFilteredSums({3e-3, 12.7e-3, 8.3e4, 0.3});
  checkAgainstFilteredSums({12e-3, 12.7e-3, 8.3e4, 0.45});
}

TEST(SurfaceField, TractionsAreTheLoad) {
  const double pressure_pa = 3 / (kWidth_rad * 12.7e-3), shear_pa = 2 / (kWidth_rad * 12.7e-3);
  const double rounding_pa = 1e-13 * pressure_pa;
  for (const double inside_rad : {0.0, -0.07, 0.0749}) {
    DOUBLES_EQUAL(-pressure_pa, at(kDefaultFinger, kLoad, inside_rad, kTrr), rounding_pa);
    DOUBLES_EQUAL(shear_pa, at(kDefaultFinger, kLoad, inside_rad, kTrt), rounding_pa);
  }
  for (const double outside_rad : {0.0751, -0.1, 3.0}) {
    DOUBLES_EQUAL(0, at(kDefaultFinger, kLoad, outside_rad, kTrr), rounding_pa);
    DOUBLES_EQUAL(0, at(kDefaultFinger, kLoad, outside_rad, kTrt), rounding_pa);
  }
}

TEST(SurfaceField, IsTheLimitFromBelow) {
  constexpr double kDepth_m = 1e-5;  // the displacements change by about strain * depth
  for (const Row row : {kUr, kUt}) {
    const double below =
        computeField(kDefaultFinger, 12.7e-3 - kDepth_m, kLoad, std::array{0.03}, std::array{row})(0, 0);
    DOUBLES_EQUAL(below, at(kDefaultFinger, kLoad, 0.03, row), 0.02 * kDepth_m);
  }
}

TEST(SurfaceField, AtTheEdgeJumpsAreHalfwayAndDisplacementsFinite) {
  constexpr double kEdge_rad = kWidth_rad / 2;
  DOUBLES_EQUAL(-1.5 / (kWidth_rad * 12.7e-3), at(kDefaultFinger, kLoad, kEdge_rad, kTrr), 1e-9);
  CHECK_TRUE(std::isinf(at(kDefaultFinger, kLoad, kEdge_rad, kErr)));
  for (const Row row : {kUr, kUt})  // the slope is a logarithm, below 1e-2
    DOUBLES_EQUAL(at(kDefaultFinger, kLoad, kEdge_rad - 1e-12, row),
                  at(kDefaultFinger, kLoad, kEdge_rad, row), 1e-14);
}

// Only a tangential load makes the radial strain logarithmic.
TEST(SurfaceField, ANormalLoadAloneHasNoInfiniteStrain) {
  SurfaceLoad press = kLoad;
  press.tangential_n_per_m = 0;
  for (const Row row : kSurfaceRows)
    CHECK_TRUE(std::isfinite(at(kDefaultFinger, press, kWidth_rad / 2, row)));
}

TEST(SurfaceField, OfANarrowLoadKeepsItsDigits) {
  const SurfaceLoad narrow{.normal_n_per_m = 1, .width_rad = 1e-6},
      line{.normal_n_per_m = 1, .width_rad = 1e-3};
  const double known = at(kDefaultFinger, line, 1.0, kUr);  // differs by width^2 / 24 of the curvature
  DOUBLES_EQUAL(known, at(kDefaultFinger, narrow, 1.0, kUr), 1e-6 * std::abs(known));
}
