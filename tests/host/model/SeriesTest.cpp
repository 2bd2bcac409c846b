#include "host/model/series.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "host/base/failure.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::model;
using namespace strainfinger::testing;

namespace {

constexpr std::array kHarmonicRows{kErr, kErt, kUr};

Eigen::MatrixXd series(double radius_m, double tolerance, const Windows& windows = {}) {
  return truncatedSeries(kDefaultFinger, radius_m, kHarmonicRows, windows, tolerance);
}

std::string complaint(double radius_m, const Windows& windows, double tolerance) {
  try {
    series(radius_m, tolerance, windows);
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
    return failure.what();
  }
  return "";
}

/// Sum of |what `kept` leaves out of `all`| over the root mean square, the worst of the columns.
double leftOut(const Eigen::MatrixXd& all, const Eigen::MatrixXd& kept) {
  double worst = 0;
  for (Eigen::Index i = 0; i < all.cols(); ++i) {
    const auto column = all.col(i);
    const double square = std::pow(column[0], 2) + column.tail(column.size() - 1).squaredNorm() / 2;
    if (square > 0)
      worst = std::max(worst, column.tail(all.rows() - kept.rows()).cwiseAbs().sum() / std::sqrt(square));
  }
  return worst;
}

}  // namespace

TEST_GROUP(Series) {};

TEST(Series, LeavesOutNoMoreThanTheTolerance) {
  for (const double radius_m : {8.9e-3, 8.91e-3, 9.4e-3, 11e-3, 12e-3, 12.6e-3})
    for (const double tolerance : {1e-2, 1e-4, 1e-8, 1e-12})
      CHECK_TRUE(leftOut(series(radius_m, 1e-30), series(radius_m, tolerance)) <= tolerance);
}

TEST(Series, KeepsToTheToleranceForEveryFinger) {
  Sampler sampler(7, {0.08, 0.97}, {0, 0.5}, 1);
  for (int i = 0; i < 300; ++i) {
    const Sample sample = sampler.next();
    if (sample.radius_m > 0.998 * sample.finger.outer_radius_m) continue;
    const auto all = truncatedSeries(sample.finger, sample.radius_m, kHarmonicRows, {}, 1e-25);
    const auto kept = truncatedSeries(sample.finger, sample.radius_m, kHarmonicRows, {}, 1e-9);
    CHECK_TRUE_TEXT(leftOut(all, kept) <= 1e-9, sample.text().c_str());
  }
}

TEST(Series, TakesFewHarmonicsFarBelowTheSurfaceAndManyNearIt) {
  LONGS_EQUAL(114, series(9.4e-3, 1e-12).rows());
  CHECK_TRUE(series(12.69e-3, 1e-12).rows() > 30000);
}

TEST(Series, OfNothingIsShort) {  // the displacements at the core
  const auto table = truncatedSeries(kDefaultFinger, 8.9e-3, std::array{kUr, kUt}, {}, 1e-15);
  CHECK_TRUE(table.isZero(0));
  CHECK_TRUE(table.rows() <= 20);
}

TEST(Series, AveragesOverTheWindows) {
  const auto points = series(9.4e-3, 1e-15),
             spread = series(9.4e-3, 1e-15, {.load_rad = 0.1, .gauge_rad = 0.4});
  const double factor = std::sin(7 * 0.05) / (7 * 0.05) * std::sin(7 * 0.2) / (7 * 0.2);
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    DOUBLES_EQUAL(points(7, i) * factor, spread(7, i), 1e-15 * std::abs(points(7, i)));
}

TEST(Series, RefusesTheSurfaceAndWhatIsTooCloseToIt) {
  for (const double radius_m : {12.7e-3, 12.69999999e-3, 12.6999e-3})
    STRCMP_CONTAINS("too close to the surface at 0.0127 m", complaint(radius_m, {}, 1e-15).c_str());
}

TEST(Series, NamesWhatIsOutsideItsDomain) {
  const double nan = std::nan("");
  for (const double radius_m : {0.0, 8.8e-3, 12.8e-3, nan})
    STRCMP_CONTAINS("outside the rubber", complaint(radius_m, {}, 1e-15).c_str());
  for (const double width_rad : {-0.1, 6.3, nan}) {
    STRCMP_CONTAINS("load's width", complaint(9e-3, {.load_rad = width_rad}, 1e-15).c_str());
    STRCMP_CONTAINS("gauge's length", complaint(9e-3, {.gauge_rad = width_rad}, 1e-15).c_str());
  }
  for (const double tolerance : {0.0, -1.0, 1.0, nan})
    STRCMP_CONTAINS("tolerance", complaint(9e-3, {}, tolerance).c_str());
}

// 32 rotations of 2e-16 each, whatever the multiple; long double's product is good for 1e-15.
TEST(Series, MultiplesOfAnAngleStayExact) {
  for (const double angle_rad : {0.0, 1e-9, 0.3, -2.5, 3.141592653589793}) {
    long double worst = 0;
    visitMultiples(angle_rad, 10000, [&](int n, double c, double s) {
      const long double phase = n * static_cast<long double>(angle_rad);
      worst = std::max({worst, std::abs(std::cos(phase) - c), std::abs(std::sin(phase) - s)});
    });
    CHECK_TRUE(worst < 7e-15L);
  }
}
