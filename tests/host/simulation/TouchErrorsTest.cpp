#include "host/simulation/touch_errors.hpp"

#include <cmath>
#include <numbers>
#include <optional>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(TouchErrors) {
  const config::Finger finger{.outer_radius_m = 0.01, .length_m = 0.02};
  static constexpr double kRad = std::numbers::pi / 180;

  static can::TouchReport report(double angle_deg, FingerFlags flags = {FingerFlag::kContact}) {
    can::TouchReport touch{{.angle_deg = angle_deg,
                            .sigmaAngle_deg = 1,
                            .normal_n = 0.4,
                            .sigmaNormal_n = 0.002,
                            .tangential_n = -0.1,
                            .sigmaTangential_n = 0.001}};
    touch.flags = flags;
    return touch;
  }
  TouchErrors of(const std::vector<Touch>& truth, FingerFlags flags) const {
    TouchErrors errors;
    errors.add({0, truth, report(10, flags)}, finger);
    return errors;
  }
};

TEST(TouchErrors, AnErrorIsAnArcAndLineLoads) {
  const TouchError error = errorOf(report(12), {10 * kRad, 19, -4}, finger);
  DOUBLES_EQUAL(2 * kRad * 0.01, error.arc_m, 1e-12);
  DOUBLES_EQUAL(1, error.normal_n_per_m, 1e-12);
  DOUBLES_EQUAL(-1, error.tangential_n_per_m, 1e-12);
  DOUBLES_EQUAL(kRad * 0.01, error.sigmaArc_m, 1e-12);
  DOUBLES_EQUAL(0.1, error.sigmaNormal_n_per_m, 1e-12);
  DOUBLES_EQUAL(0.05, error.sigmaTangential_n_per_m, 1e-12);
}

TEST(TouchErrors, TheArcIsTheShortWayAroundInAnyRevolution) {
  DOUBLES_EQUAL(-2 * kRad * 0.01, errorOf(report(359), {1 * kRad, 1, 0}, finger).arc_m, 1e-12);
  DOUBLES_EQUAL(2 * kRad * 0.01, errorOf(report(1), {(720 - 1) * kRad, 1, 0}, finger).arc_m, 1e-12);
}

TEST(TouchErrors, ADeviationHasRmsAndLargestMagnitude) {
  Deviation deviation;
  deviation.add(3);
  deviation.add(-4);
  DOUBLES_EQUAL(std::sqrt(12.5), deviation.rms(), 1e-12);
  DOUBLES_EQUAL(4, deviation.worst(), 0);
}

TEST(TouchErrors, WithoutValuesADeviationIsUnknown) {
  CHECK_TRUE(std::isnan(Deviation().rms()));
  CHECK_TRUE(std::isnan(Deviation().worst()));
}

TEST(TouchErrors, OnlyCertainReportsOfOneTouchCount) {
  const std::vector<Touch> one{{0, 20, 0}}, two{{0, 20, 0}, {2, 20, 0}};
  LONGS_EQUAL(1, of(one, {FingerFlag::kContact}).arc_m.count());
  LONGS_EQUAL(1, of(one, {FingerFlag::kContact, FingerFlag::kUncertain}).uncertain);
  LONGS_EQUAL(1, of(two, {FingerFlag::kContact}).several);
  LONGS_EQUAL(1, of({}, {FingerFlag::kContact}).phantom);
  LONGS_EQUAL(1, of(one, {}).missed);
  LONGS_EQUAL(0, of({}, {}).missed);
  LONGS_EQUAL(0, of(one, {FingerFlag::kContact, FingerFlag::kUncertain}).arc_m.count());
}

TEST(TouchErrors, TheTimeOfATouchThatIsNotToldIsCounted) {
  const std::vector<Touch> one{{0, 20, 0}};
  TouchErrors errors;
  const auto pass = [&](const std::vector<Touch>& truth, std::optional<FingerFlags> told = {}) {
    Moment moment{0, truth, std::nullopt};
    if (told) moment.compared = ComparedTouch{0, truth, report(10, *told)};
    errors.add(moment, finger);
  };
  pass({});
  pass(one);
  pass(one);
  pass(one, FingerFlags{FingerFlag::kContact});
  pass(one);
  pass({}, FingerFlags{});
  pass(one);
  DOUBLES_EQUAL(3e-3, errors.untold_s, 1e-12);
}
