#include "host/cli/touch_recorder.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "common/fixed_real.hpp"
#include "common/quantities.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::cli;

TEST_GROUP(TouchRecorder) {
  config::FingerConfig config;
  simulation::GaugeStrains strains{config};
  firmware::Readings readings;
  TouchRecorder recorder{config, std::vector(16, 1.0)};
  static constexpr double kRad = std::numbers::pi / 180;

  /// A moment with a report that is 0.1 deg ahead of the truth.
  void reported(double time_s, double angle_deg, double normal_n_per_m) {
    simulation::Moment moment{time_s, {{angle_deg * kRad, normal_n_per_m, 0}}, std::nullopt};
    moment.compared = {time_s, moment.truth, {}};
    moment.compared->report.angle_deg = angle_deg + 0.1;
    moment.compared->report.normal_n = normal_n_per_m * config.finger.length_m;
    moment.compared->report.tangential_n = 0;
    moment.compared->report.flags = {FingerFlag::kContact};
    recorder.add(moment, readings);
  }
  /// Touched at 40 and 200 deg; told is what the report says, in this order.
  void twoTouches(double time_s, const std::vector<double>& told_deg) {
    simulation::Moment moment{time_s, {{40 * kRad, 20, 0}, {200 * kRad, 10, 0}}, std::nullopt};
    moment.compared = {time_s, moment.truth, {}};
    moment.compared->report.flags = {FingerFlag::kContact};
    moment.compared->report.angle_deg = told_deg.at(0);
    if (told_deg.size() > 1) moment.compared->report.second = can::ContactReport{.angle_deg = told_deg[1]};
    recorder.add(moment, readings);
  }
  void silent(double time_s) { recorder.add({time_s, {}, std::nullopt}, readings); }
};

TEST(TouchRecorder, KeepsOnePointAPeriod) {
  for (int sample = 1; sample <= 1000; ++sample) silent(sample * 1e-3);
  LONGS_EQUAL(std::lround(1 / TouchRecorder::kTrackPeriod_s), recorder.record(strains).track.size());
}

TEST(TouchRecorder, TheFirstReportOfAPeriodTakesThePointsPlace) {
  silent(1);
  reported(1.002, 40, 20);
  reported(1.004, 50, 20);
  const auto track = recorder.record(strains).track;
  LONGS_EQUAL(1, track.size());
  DOUBLES_EQUAL(1.002, track[0].time_s, 1e-12);
  DOUBLES_EQUAL(40, track[0].contacts[0].truth.angle_deg, 1e-9);
  DOUBLES_EQUAL(40.1, track[0].contacts[0].estimate.angle_deg, 1e-9);
  DOUBLES_EQUAL(20, track[0].contacts[0].estimate.normal_n_per_m, 1e-9);
}

TEST(TouchRecorder, WithoutTouchOrReportThePointHasNoContact) {
  silent(1);
  const auto track = recorder.record(strains).track;
  CHECK_TRUE(track[0].contacts.empty());
}

TEST(TouchRecorder, EachTouchHasTheNearestContactThatIsTold) {
  twoTouches(1, {201, 41});
  twoTouches(2, {199});
  const auto track = recorder.record(strains).track;
  DOUBLES_EQUAL(41, track.at(0).contacts.at(0).estimate.angle_deg, 1e-9);
  DOUBLES_EQUAL(201, track.at(0).contacts.at(1).estimate.angle_deg, 1e-9);
  CHECK_TRUE(std::isnan(track.at(1).contacts.at(0).estimate.angle_deg));
  DOUBLES_EQUAL(199, track.at(1).contacts.at(1).estimate.angle_deg, 1e-9);
}

TEST(TouchRecorder, AContactThatIsToldOfNoTouchIsKeptBehindTheTouches) {
  simulation::Moment moment{1, {}, std::nullopt};
  moment.compared = {1, {}, {}};
  moment.compared->report.flags = {FingerFlag::kContact};
  moment.compared->report.angle_deg = 77;
  recorder.add(moment, readings);
  const auto contacts = recorder.record(strains).track.at(0).contacts;
  LONGS_EQUAL(1, contacts.size());
  CHECK_TRUE(std::isnan(contacts[0].truth.angle_deg));
  DOUBLES_EQUAL(77, contacts[0].estimate.angle_deg, 1e-9);
}

TEST(TouchRecorder, ASetWhoseContactsWereAllToldIsRatherShown) {
  twoTouches(1, {40, 200});
  twoTouches(2, {40});
  reported(3, 90, 25);
  const auto record = recorder.record(strains);
  DOUBLES_EQUAL(1, record.moment_s, 0);
  LONGS_EQUAL(2, record.contacts.size());
}

TEST(TouchRecorder, WhereNoContactIsToldRightItIsRatherATouchThanTheRestAfterIt) {
  twoTouches(1, {40});
  simulation::Moment rest{2, {}, std::nullopt};
  rest.compared = {2, {}, {}};
  recorder.add(rest, readings);
  DOUBLES_EQUAL(1, recorder.record(strains).moment_s, 0);
}

TEST(TouchRecorder, TheProfileIsThatOfTheHardestTouch) {
  reported(1, 40, 20);
  readings.strain_q32[3] = 1 << 22;
  reported(2, 90, 30);
  readings.strain_q32[3] = 0;
  reported(3, 200, 10);
  const auto record = recorder.record(strains);
  DOUBLES_EQUAL(2, record.moment_s, 0);
  DOUBLES_EQUAL(90.1, record.contacts.at(0).estimate.angle_deg, 1e-9);
  LONGS_EQUAL(16, record.readings.size());
  DOUBLES_EQUAL(std::ldexp(1.0, -10), record.readings[3].strain, 1e-12);
  DOUBLES_EQUAL(67.5, record.readings[3].angle_deg, 1e-9);
}

TEST(TouchRecorder, TruthAndFitAreTheModelAllTheWayAround) {
  reported(2, 90, 30);
  const auto profile = recorder.record(strains).profile;
  DOUBLES_EQUAL(0, profile.front().angle_deg, 0);
  DOUBLES_EQUAL(360, profile.back().angle_deg, 0);
  const simulation::Touch truth[] = {{90 * kRad, 30, 0}}, fitted[] = {{90.1 * kRad, 30, 0}};
  for (const auto& point : profile) {
    DOUBLES_EQUAL(strains.at(point.angle_deg * kRad, truth), point.true_strain, 1e-12);
    DOUBLES_EQUAL(strains.at(point.angle_deg * kRad, fitted), point.fitted_strain, 1e-12);
  }
}

// The firmware knows a gauge's gain and depth: what it makes of the reading is no error of the fit.
TEST(TouchRecorder, WhatACalibrationKnowsOfEachGaugeIsInTheFit) {
  config.calibration.gain = std::vector(16, 1.0);
  config.calibration.depth_offset_m = std::vector(16, 0.0);
  config.calibration.gain[4] = 1.05;
  config.calibration.depth_offset_m[4] = 1e-4;
  config.calibration.depth_offset_m[5] = -1e-4;
  const simulation::GaugeStrains built{config};
  std::vector<double> factors(16, 1.0);
  factors[4] = 0.9;
  recorder = TouchRecorder(config, factors);
  const simulation::Touch touch[] = {{90.1 * kRad, 30, 0}};
  const auto read = built.readings(touch);
  for (std::size_t i = 0; i < factors.size(); ++i)
    readings.strain_q32[i] = fromReal<StrainQ32>(read[static_cast<Eigen::Index>(i)] * factors[i]).raw();
  reported(2, 90, 30);
  for (const auto& reading : recorder.record(built).readings)
    DOUBLES_EQUAL(reading.strain, reading.fitted_strain, 1e-9);
}
