#include "host/calibration/touch_fit.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "host/model/pressure_profile.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(TouchFit) {
  const config::FingerConfig config;
  const Drawing drawing{config};
  const RingResponse ring{drawing, Eigen::VectorXd::Zero(drawing.unknowns()),
                          RingResponse::lastHarmonic(drawing)};
  const TouchSearch search{ring, config};
  std::mt19937_64 random{20241121};

  double between(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  }
  TouchState someTouch() {
    const double normal = between(5, 40);
    return {between(0, 2 * std::numbers::pi), normal, normal * between(-0.9, 0.9),
            model::momentOfWidth(between(0.2e-3, 4e-3) / config.finger.outer_radius_m)};
  }
  TouchData dataOf(const TouchState& touch) { return {ring.readings(touch), 6e-6, {}}; }
};

TEST(TouchFit, FindsTouchesFromTheirReadingsAlone) {
  for (int i = 0; i < randomCases(100); ++i) {
    const TouchState touch = someTouch();
    const TouchFit found = search.find(ring, dataOf(touch));
    DOUBLES_EQUAL(0, std::remainder(found.touch[kPlace] - touch[kPlace], 2 * std::numbers::pi), 1e-5);
    DOUBLES_EQUAL(touch[kNormalLoad], found.touch[kNormalLoad], 1e-2);
    DOUBLES_EQUAL(touch[kTangentialLoad], found.touch[kTangentialLoad], 1e-2);
    CHECK_COMPARE(found.chiSquared, <, 0.1);
  }
}

TEST(TouchFit, AKnownPlaceInAnyRevolutionIsKept) {
  TouchData data = dataOf({1, 20, 5, 1e-3});
  data.prior.value[kPlace] = 1.001 + 2 * std::numbers::pi;
  data.prior.weight[kPlace] = 1e9;
  DOUBLES_EQUAL(1.001, search.find(ring, data).touch[kPlace], 1e-6);
}

TEST(TouchFit, AWideTouchBetweenGaugesHasARivalAndANarrowOneOverAGaugeHasNone) {
  const double wide_rad2 = model::momentOfWidth(5e-3 / config.finger.outer_radius_m);
  int rivals = 0;
  for (int i = 0; i < 8; ++i)
    rivals +=
        search.find(ring, dataOf({(0.5 + i / 8.0) * std::numbers::pi / 8, 5, 1, wide_rad2})).rivalGap < 16;
  CHECK_COMPARE(rivals, >, 0);
  CHECK_COMPARE(search.find(ring, dataOf({0, 30, 2, 1e-4})).rivalGap, >, 100);
}

TEST(TouchFit, WhatNothingPressesIsNotFound) {
  TouchData pulled = dataOf({1, -20, 0, 1e-3});
  CHECK_COMPARE(search.find(ring, pulled).chiSquared, >, 1e4);
}

TEST(TouchFit, NineteenOfTwentyGuessesAreWithinATenthOfAGap) {
  const double gap = 2 * std::numbers::pi / 16;
  const int cases = randomCases(1000);
  int away = 0, wrongLoad = 0;
  for (int i = 0; i < cases; ++i) {
    const TouchState touch = someTouch();
    const TouchState guess = search.guess(ring.readings(touch));
    away += std::abs(std::remainder(guess[kPlace] - touch[kPlace], 2 * std::numbers::pi)) > 0.1 * gap;
    wrongLoad += std::abs(guess[kNormalLoad] / touch[kNormalLoad] - 1) > 0.25;
  }
  CHECK_COMPARE(20 * away, <=, cases);
  CHECK_COMPARE(20 * wrongLoad, <=, cases);
}

TEST(TouchFit, OfNothingThereIsNoGuess) {
  DOUBLES_EQUAL(0, search.guess(Eigen::VectorXd::Zero(16)).norm(), 0);
}
