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

TEST(TouchErrors, EachTouchHasTheNearestContactThatIsLeft) {
  const auto check = [](const std::vector<double>& expected_deg, const std::vector<double>& touches_deg,
                        double first_deg, std::optional<double> second_deg = {}) {
    std::vector<Touch> truth;
    for (const double touch_deg : touches_deg) truth.push_back({touch_deg * kRad, 1, 0});
    can::TouchReport both = report(first_deg);
    if (second_deg) both.second = can::ContactReport{.angle_deg = *second_deg};
    const auto told = toldTouches(truth, both);
    LONGS_EQUAL(expected_deg.size(), told.size());
    for (std::size_t i = 0; i < told.size(); ++i) {
      CHECK_EQUAL(i < truth.size(), told[i].truth.has_value());
      CHECK_EQUAL(!std::isnan(expected_deg[i]), told[i].contact.has_value());
      if (told[i].contact) DOUBLES_EQUAL(expected_deg[i], told[i].contact->angle_deg, 0);
    }
  };
  check({kNoValue, 33, kNoValue}, {10, 40, 350}, 33);
  check({0.5, kNoValue, -11}, {10, 40, 350}, -11, 0.5);
  check({24, 30, kNoValue}, {10, 40, 350}, 30, 24);  // 24 deg is nearer to 10 than 30 is
  check({12, 14}, {10}, 12, 14);
  check({5, 7}, {}, 5, 7);
  LONGS_EQUAL(0, toldTouches({}, report(5, {})).size());
}

TEST(TouchErrors, AContactOfUnknownPlaceIsTheLastToFindATouch) {
  can::TouchReport both = report(kNoValue);
  both.second = can::ContactReport{.angle_deg = 170};
  DOUBLES_EQUAL(170, toldTouches({{0, 1, 0}}, both).at(0).contact->angle_deg, 0);
}

TEST(TouchErrors, BothOfTwoContactsAreCompared) {
  const std::vector<Touch> two{{100 * kRad, 20, 0}, {10 * kRad, 20, 0}};
  can::TouchReport both = report(10.5);
  both.second = report(100.1);
  TouchErrors errors;
  errors.add({0, two, both}, finger);
  LONGS_EQUAL(2, errors.arc_m.count());
  DOUBLES_EQUAL(0.5 * kRad * 0.01, errors.arc_m.worst(), 1e-12);
}

TEST(TouchErrors, OnlyCertainReportsOfAsManyContactsAsTouchesCount) {
  const std::vector<Touch> one{{0, 20, 0}}, two{{0, 20, 0}, {2, 20, 0}};
  LONGS_EQUAL(1, of(one, {FingerFlag::kContact}).arc_m.count());
  LONGS_EQUAL(1, of(one, {FingerFlag::kContact, FingerFlag::kUncertain}).uncertain);
  LONGS_EQUAL(1, of(two, {FingerFlag::kContact}).otherNumber);
  LONGS_EQUAL(0, of(two, {FingerFlag::kContact}).arc_m.count());
  LONGS_EQUAL(1, of(two, {FingerFlag::kContact, FingerFlag::kUncertain}).uncertain);
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
