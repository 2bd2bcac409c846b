#include "host/shape/plausible_touches.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <numbers>

#include "tests/host/shape/rings.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

TEST_GROUP(PlausibleTouches) {
  static constexpr double kNoise = 1e-3;  ///< of the peak strain

  /// Of a touch of 10 N/m whose place and width the ring tells well, or not.
  static PlausibleTouches around(int gauges, const Touch& touch, double noise, TouchFit* fit = nullptr) {
    const config::FingerConfig config = ringOf(0.7, gauges);
    const TouchModel model(config);
    const double strain = noise * 10 * peakStrain(config);
    const Eigen::VectorXd strains = ellipseStrains(config, touch);
    const TouchFit end = refine(model, Profile::kEllipse, strains, strain, touch);
    if (fit != nullptr) *fit = end;
    return plausibleTouches(model, strains, strain, end);
  }
};

// A normal distribution's sums are its covariance.
TEST(PlausibleTouches, WeighAsTheFitsOwnCovarianceWhereTheModelIsStraight) {
  TouchFit fit;
  const auto places = around(32, {1, 10, 3, momentOfWidth(4e-3 / kSurface_m)}, kNoise, &fit);
  CHECK_TRUE(places.areAll);
  double weights = 0, square = 0;
  for (const PlausibleTouch& place : places.touches) {
    const double weight = std::exp((fit.chiSquared - place.chiSquared) / 2);
    weights += weight;
    square += weight * std::pow(place.touch.angle_rad - fit.touch.angle_rad, 2);
  }
  DOUBLES_EQUAL(1, square / weights / fit.covariance(0, 0), 0.03);  // 0.7 % lie outside
}

TEST(PlausibleTouches, ExplainTheReadingsAlmostAsWellAsTheFit) {
  TouchFit fit;
  for (const PlausibleTouch& place : around(16, {1, 10, 3, 0}, 1e-2, &fit).touches) {
    CHECK_TRUE(place.chiSquared < fit.chiSquared + kPlausible);
    CHECK_TRUE(place.area > 0 && place.loadCovariance.determinant() > 0);
  }
}

// A fifth of a pitch beside one of 16 gauges: far more places than a straight valley's 40.
TEST(PlausibleTouches, FollowABentValley) {
  const double beside_rad = 0.2 * 2 * std::numbers::pi / 16;
  CHECK_TRUE(around(16, {beside_rad, 10, -2, 0}, 1e-2).touches.size() > 60);
  CHECK_TRUE(around(32, {beside_rad, 10, -2, 0}, 1e-3).touches.size() < 50);
}

TEST(PlausibleTouches, OfAFitWithoutSigmasThereAreNone) {
  const config::FingerConfig config = ringOf(0.7, 16);
  const TouchModel model(config);
  const TouchFit fit{{}, Eigen::Matrix4d::Constant(std::numeric_limits<double>::infinity()), 0, false};
  const auto places = plausibleTouches(model, Eigen::VectorXd::Zero(16), 1e-5, fit);
  CHECK_TRUE(places.touches.empty() && !places.areAll);
}
