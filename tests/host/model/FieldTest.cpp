#include "host/model/field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/model/series.hpp"
#include "tests/host/model/exact_field.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::model;
using namespace strainfinger::testing;

namespace {

constexpr std::array kAllRows{kTrr, kTrt, kTtt, kUr, kUt, kErr, kEtt, kErt};
constexpr std::array kAngles_rad{0.0, 0.05, -0.15, 0.3, 0.8, -1.5, 2.5, std::numbers::pi};

double computeAt(const Annulus<double>& finger, double radius_m, const SurfaceLoad& load, double angle_rad,
                 Row row) {
  return computeField(finger, radius_m, load, std::array{angle_rad}, std::array{row})(0, 0);
}

/// A line of fem.csv.
struct Reference {
  SurfaceLoad load;
  double poisson_ratio, angle_rad, errFem, errCollocation, ertFem, ertCollocation;
};

std::vector<Reference> references() {
  std::ifstream file(STRAINFINGER_TEST_DATA "/fem.csv");
  std::vector<Reference> rows;
  std::string line;
  for (std::getline(file, line); std::getline(file, line);) {
    std::istringstream fields(line);
    std::string load, field;
    std::getline(fields, load, ',');
    std::vector<double> numbers;
    while (std::getline(fields, field, ',')) numbers.push_back(std::stod(field));
    const double degree = std::numbers::pi / 180, isNormal = load == "normal";
    rows.push_back({{isNormal, 1 - isNormal, 0, 0.5 * degree},
                    numbers.at(0),
                    numbers.at(1) * degree,
                    numbers.at(2),
                    numbers.at(3),
                    numbers.at(4),
                    numbers.at(5)});
  }
  return rows;
}

/// Of every row, relative to its peak; zeros are exact.
double worstError(const Annulus<double>& finger, double radius_m, const SurfaceLoad& load) {
  const ExactField exact(finger, radius_m);
  const Eigen::MatrixXd field = computeField(finger, radius_m, load, kAngles_rad, kAllRows);
  Eigen::MatrixXd errors = field;
  for (Eigen::Index k = 0; k < field.rows(); ++k) {
    const auto known = exact.at(load, kAngles_rad[static_cast<std::size_t>(k)]);
    for (Eigen::Index i = 0; i < field.cols(); ++i)
      errors(k, i) =
          static_cast<double>(std::abs(known[kAllRows[static_cast<std::size_t>(i)]] - field(k, i)));
  }
  double worst = 0;
  for (Eigen::Index i = 0; i < field.cols(); ++i) {
    const double peak = field.col(i).cwiseAbs().maxCoeff(), error = errors.col(i).maxCoeff();
    worst = std::max(worst, peak > 0 ? error / peak : error > 1e-60 ? 1 : 0);
  }
  return worst;
}

}  // namespace

TEST_GROUP(Field) {};

// The bar is 1e-12 of the peak of the radial strain; this is every row, at the core and at nu = 1/2 too.
TEST(Field, AgreesWithExactSumsAtEveryDepth) {
  for (const double radius_m : {8.9e-3, 8.9001e-3, 9.4e-3, 11e-3, 12.3e-3})
    CHECK_TRUE(worstError(kDefaultFinger, radius_m, {3, -2, 0, 0}) < 2e-14);
}

TEST(Field, AgreesWithExactSumsForOtherFingers) {
  CHECK_TRUE(worstError({2e-3, 12.7e-3, 8.3e4, 0.3}, 4e-3, {3, -2, 0, 0}) < 2e-14);
  CHECK_TRUE(worstError({2e-3, 12.7e-3, 8.3e4, 0.5 - 1e-9}, 2e-3, {3, -2, 0, 0.1}) < 2e-14);
  CHECK_TRUE(worstError({11.5e-3, 12.7e-3, 1e6, 0.5}, 12e-3, {3, -2, 0, 0.1}) < 2e-14);
  CHECK_TRUE(worstError({8.9e-3, 12.7e-3, 8.3e4, 0}, 9e-3, {3, -2, 0, 1.5}) < 2e-14);
}

// The collocation is printed to 1e-10, so half of that is what an exact model may differ by.
// 43,000 harmonics, 13 um below the surface. Known by the same template in long double, 19 digits.
TEST(Field, KeepsItsDigitsCloseToTheSurface) {
  constexpr std::array kTwoRows{kErr, kTrt};
  constexpr double kRadius_m = 12.7e-3 * (1 - 1e-3);
  constexpr int kLast = 45'000;
  constexpr SurfaceLoad kBoth{.normal_n_per_m = 1, .tangential_n_per_m = 0.5};
  const std::vector<double> angles_rad{0, 3e-4, -1e-3, 0.01, -2};
  const HarmonicModel<long double> responses({8.9e-3, 12.7e-3, 8.3e4, 0.5}, kRadius_m);
  Eigen::MatrixX<long double> table(kLast + 1, 4);
  for (int n = 0; n <= kLast; ++n)
    for (Eigen::Index i = 0; i < 2; ++i)
      table.block<1, 2>(n, 2 * i) = responses(n).row(kTwoRows[static_cast<std::size_t>(i)]);
  const Annulus<double> finger{8.9e-3, 12.7e-3, 8.3e4, 0.5};
  const Eigen::MatrixXd known = sumSeries(table, kTwoRows, finger, kBoth, angles_rad).cast<double>();
  const Eigen::MatrixXd found = computeField(finger, kRadius_m, kBoth, angles_rad, kTwoRows);
  for (Eigen::Index i = 0; i < 2; ++i)
    DOUBLES_EQUAL(0, (found - known).col(i).cwiseAbs().maxCoeff() / known.col(i).cwiseAbs().maxCoeff(),
                  5e-15);
}

TEST(Field, AgreesWithCollocation) {
  LONGS_EQUAL(40, references().size());
  for (const Reference& known : references()) {
    const Annulus<double> finger{8.9e-3, 12.7e-3, 8.3e4, known.poisson_ratio};
    const double printed = 0.5001e-10;
    DOUBLES_EQUAL(known.errCollocation, computeAt(finger, kGaugeRadius_m, known.load, known.angle_rad, kErr),
                  printed);
    DOUBLES_EQUAL(known.ertCollocation, computeAt(finger, kGaugeRadius_m, known.load, known.angle_rad, kErt),
                  printed);
  }
}

TEST(Field, AgreesWithFiniteElements) {
  for (const Reference& known : references()) {
    const Annulus<double> finger{8.9e-3, 12.7e-3, 8.3e4, known.poisson_ratio};
    const double printed = 1e-10, err = std::abs(known.errFem - known.errCollocation) + printed,
                 ert = std::abs(known.ertFem - known.ertCollocation) + printed;
    DOUBLES_EQUAL(known.errFem, computeAt(finger, kGaugeRadius_m, known.load, known.angle_rad, kErr), err);
    DOUBLES_EQUAL(known.ertFem, computeAt(finger, kGaugeRadius_m, known.load, known.angle_rad, kErt), ert);
  }
}

TEST(Field, TurnsWithTheLoad) {
  const SurfaceLoad here{1, 2, 0, 0.1}, there{1, 2, -2.5, 0.1};
  for (const Row row : kAllRows)
    DOUBLES_EQUAL(computeAt(kDefaultFinger, 10e-3, here, 0.25, row),
                  computeAt(kDefaultFinger, 10e-3, there, -2.25, row), 1e-13 * (row <= kTtt ? 1e3 : 1e-2));
}

TEST(Field, ANarrowLoadIsALineLoad) {
  const double line = computeAt(kDefaultFinger, kGaugeRadius_m, {1, 0, 0, 0}, 0.1, kErr);
  DOUBLES_EQUAL(line, computeAt(kDefaultFinger, kGaugeRadius_m, {1, 0, 0, 1e-6}, 0.1, kErr), 1e-13);
}

TEST(Field, ALoadAllAroundIsTheZerothHarmonic) {
  const Annulus<double> finger{8.9e-3, 12.7e-3, 8.3e4, 0.3};
  const double all = 2 * std::numbers::pi;
  const double pressure_pa = -1 / (all * finger.outer_radius_m);
  for (const double radius_m : {10e-3, 12.7e-3}) {
    const double known = HarmonicModel<double>(finger, radius_m)(0)(kUr, kNormal) * pressure_pa;
    DOUBLES_EQUAL(known, computeAt(finger, radius_m, {1, 0, 0, all}, 2, kUr), 1e-13 * std::abs(known));
  }
}

TEST(Field, RefusesALineLoadAtTheSurface) {
  CHECK_THROWS(Failure, computeAt(kDefaultFinger, 12.7e-3, {1, 0, 0, 0}, 1, kUr));
}

TEST(Field, RefusesWhatIsOutsideItsDomain) {
  CHECK_THROWS(Failure, computeAt(kDefaultFinger, 8e-3, {1, 0, 0, 0}, 1, kUr));
  CHECK_THROWS(Failure, computeAt(kDefaultFinger, 12.7e-3, {1, 0, 0, 6.3}, 1, kUr));
  CHECK_THROWS(Failure, computeAt(kDefaultFinger, 12.7e-3, {1, 0, 0, std::nan("")}, 1, kUr));
}
