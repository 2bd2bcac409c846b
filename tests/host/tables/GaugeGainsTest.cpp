#include "host/tables/gauge_gains.hpp"

#include <memory>
#include <string>
#include <vector>

#include "firmware/core/condition.hpp"
#include "host/base/failure.hpp"
#include "host/tables/table_builder.hpp"
#include "host/tables/table_text.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

namespace {

GaugeGains tabledGains(const config::FingerConfig& config) { return gaugeGains(config, depthFit(config)); }

}  // namespace

TEST_GROUP(GaugeGains) {
  config::FingerConfig configWith(double first, double others) {
    config::FingerConfig config;
    config.calibration.gain.assign(static_cast<std::size_t>(config.gauges.count), others);
    config.calibration.gain[0] = first;
    return config;
  }

  void checkFactor(double gain, double tolerance) {
    const auto factors = correctionFactors(tabledGains(configWith(gain, 1)), 16);
    DOUBLES_EQUAL(1 / gain, factors[0], tolerance);
    DOUBLES_EQUAL(1, factors[15], 0);
  }
};

TEST(GaugeGains, AreThereOnlyAfterCalibration) {
  CHECK_FALSE(tabledGains({}).areKnown());
  CHECK_TRUE(tabledGains(configWith(1, 1)).areKnown());
  DOUBLES_EQUAL(1, correctionFactors(tabledGains({}), 16)[3], 0);
}

TEST(GaugeGains, HaveStepsOf60MillionthsFromAHalfToTwo) {
  for (const double gain : {1.001, 0.9, 1.1, 0.7, 2.0, 0.5}) checkFactor(gain, 0x1p-15);
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

TEST(GaugeGains, AFullScaleThatTheFirmwareDoesNotHoldIsNamed) {
  for (const double gain : {0.97, 0.95}) {
    config::FingerConfig config = configWith(1, gain);
    config.gauges.full_scale_strain = 0.06;
    config.gauges.noise_strain = 2e-5;
    try {
      CHECK(checkTableImage(buildTableImage(config)) == TableFault::kNone);
      CHECK(gain > 0.96);  // 0.06 / 0.0625
    } catch (const Failure& failure) {
      CHECK(gain < 0.96);
      LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
      STRCMP_CONTAINS("makes its full scale 0.06316; the firmware holds 0.0625", failure.what());
    }
  }
}

TEST(GaugeGains, AGaugeThatLiesTooDeepToReadAnythingIsNamed) {
  config::FingerConfig config = configWith(1, 1);
  config.calibration.depth_offset_m.assign(16, 0);
  config.calibration.depth_offset_m[7] = 5e-4;  // on the core
  try {
    tabledGains(config);
    FAIL("accepted");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("calibration.depth_offset_m[7] = 0.0005: so deep", failure.what());
    STRCMP_CONTAINS("the tables correct 0.333 and more", failure.what());
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
