#include "host/tables/gauge_gains.hpp"

#include <Eigen/Core>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "firmware/core/condition.hpp"
#include "host/base/failure.hpp"
#include "host/model/impulse_response.hpp"
#include "host/tables/table_builder.hpp"
#include "host/tables/table_file.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

TEST_GROUP(GaugeGains){
    config::FingerConfig configWith(double first, double others){config::FingerConfig config;
config.calibration.gain.assign(static_cast<std::size_t>(config.gauges.count), others);
config.calibration.gain[0] = first;
return config;
}

void checkFactor(double gain, double tolerance) {
  const auto factors = correctionFactors(gaugeGains(configWith(gain, 1)), 16);
  DOUBLES_EQUAL(1 / gain, factors[0], tolerance);
  DOUBLES_EQUAL(1, factors[15], 0);
}
}
;

TEST(GaugeGains, AreThereOnlyAfterCalibration) {
  CHECK_FALSE(gaugeGains({}).isCalibrated());
  CHECK_TRUE(gaugeGains(configWith(1, 1)).isCalibrated());
  DOUBLES_EQUAL(1, correctionFactors(gaugeGains({}), 16)[3], 0);
}

// Half a step of the exponent that holds the correction, 1 / gain - 1, in 127 steps.
TEST(GaugeGains, HaveStepsThatSuitTheLargest) {
  checkFactor(1.001, 0x1p-16);
  checkFactor(0.9, 0x1p-11);
  checkFactor(1.1, 0x1p-11);
  checkFactor(0.7, 0x1p-9);
  checkFactor(2, 0x1p-8);
  checkFactor(0.5, 0x1p-7);
}

TEST(GaugeGains, EveryGainOfTheDomainMakesTablesThatTheFirmwareTakes) {
  for (const double gain : {0.5, 0.9, 1.0, 1.1, 2.0})
    for (const double others : {0.5, 1.0, 2.0}) {
      const TableImage image = buildTableImage(configWith(gain, others));
      CHECK(checkTableImage(image) == TableFault::kNone);
    }
}

// There the gains of the ring fill the words of conditioning to the last bit.
TEST(GaugeGains, AFullScaleThatIsAPowerOfTwoMakesTablesThatTheFirmwareTakes) {
  config::FingerConfig config = configWith(0.5, 1);
  config.gauges.full_scale_strain = 0x1p-6;
  CHECK(checkTableImage(buildTableImage(config)) == TableFault::kNone);
  config.calibration.gain.clear();
  CHECK(checkTableImage(buildTableImage(config)) == TableFault::kNone);
}

// Oracle: least squares over angles and both loads, of strains computed one by one.
TEST(GaugeGains, FollowTheDepthOfEachGauge) {
  config::FingerConfig config = configWith(1, 1);
  config.calibration.depth_offset_m.assign(16, 0);
  config.calibration.depth_offset_m[3] = 1e-4;
  const auto strains = [&](double radius_m) {
    const model::ImpulseResponse response(config.finger.annulus(), radius_m, config.gauges.component);
    std::vector<double> values;
    for (int i = 0; i < 360; ++i) {
      const auto value = response.at(i * std::numbers::pi / 180);
      values.insert(values.end(), {value.normal, value.tangential});
    }
    return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(values.data(), 720));
  };
  const Eigen::VectorXd drawn = strains(9.4e-3), deeper = strains(9.3e-3);
  const double gain = deeper.dot(drawn) / drawn.squaredNorm();
  CHECK(gain > 0.7 && gain < 0.95);
  DOUBLES_EQUAL(1 / gain, correctionFactors(gaugeGains(config), 16)[3], 0x1p-9);
  DOUBLES_EQUAL(1, correctionFactors(gaugeGains(config), 16)[4], 0);
  config.calibration.gain.clear();
  DOUBLES_EQUAL(1 / gain, correctionFactors(gaugeGains(config), 16)[3], 0x1p-9);
}

// Oracle: what the factor leaves at 360 angles. One gauge of 16 is off: its share of the ring's RMS is 1/4.
TEST(GaugeGains, WhatADepthAsAFactorLeavesIsPartOfTheModelsError) {
  config::FingerConfig config = configWith(1, 1);
  DOUBLES_EQUAL(0, depthError(config), 0);
  config.calibration.depth_offset_m.assign(16, 0);
  config.calibration.depth_offset_m[3] = 1e-4;
  const model::ImpulseResponse drawn(config.finger.annulus(), 9.4e-3, config.gauges.component);
  const model::ImpulseResponse deeper(config.finger.annulus(), 9.3e-3, config.gauges.component);
  const double gain = 1 / correctionFactors(gaugeGains(config), 16)[3];
  double left = 0;
  for (int i = 0; i < 360; ++i) {
    const auto there = drawn.at(i * std::numbers::pi / 180), here = deeper.at(i * std::numbers::pi / 180);
    left = std::max({left, std::abs(here.normal - gain * there.normal),
                     std::abs(here.tangential - gain * there.tangential)});
  }
  const double share = left / std::abs(drawn.at(0).normal) / 4;
  CHECK(share > 2e-3 && share < 5e-3);
  DOUBLES_EQUAL(share, depthError(config), 0.05 * share);  // the factor is rounded to 2^-9 in the tables
  config.gauges.model_error = 0;
  DOUBLES_EQUAL(std::ldexp(depthError(config), 16), buildTableImage(config).constants.model_error_q16, 0.5);
}

TEST(GaugeGains, AGaugeThatLiesTooDeepToReadAnythingIsNamed) {
  config::FingerConfig config = configWith(1, 1);
  config.calibration.depth_offset_m.assign(16, 0);
  config.calibration.depth_offset_m[7] = 5e-4;  // on the core
  try {
    gaugeGains(config);
    FAIL("accepted");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("calibration.depth_offset_m[7] = 0.0005: so deep", failure.what());
    STRCMP_CONTAINS("the tables correct 0.335 and more", failure.what());
  }
}

TEST(GaugeGains, ReachTheFirmwaresCalibration) {
  const auto image = std::make_unique<TableImage>(buildTableImage(configWith(0.8, 1)));
  const auto calibration = firmware::tabledCalibration(*image);
  DOUBLES_EQUAL(1.25 * calibration.gain[15], calibration.gain[0], 2);
  LONGS_EQUAL(image->constants.reading_gain, calibration.gain[15]);
}

TEST(GaugeGains, TablesOfOtherGainsAreAnotherFingers) {
  const TableImage image = buildTableImage(configWith(0.8, 1));
  requireTablesOf(image, configWith(0.8, 1), "f.bin");
  try {
    requireTablesOf(image, {}, "f.bin");
    FAIL("accepted");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kMismatch), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("calibration.gain is [0.8, 1, 1, ", failure.what());
    STRCMP_CONTAINS("the config has []", failure.what());
  }
}
