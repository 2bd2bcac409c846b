#include "host/config/unseen_errors.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::config;

TEST_GROUP(UnseenErrors) {
  FingerConfig config;
  double modelError() const { return unseenErrors(config).modelError; }
  double loadScale() const { return unseenErrors(config).loadScale; }
};

// That loads near the core are as far off as this says is for closed_loop, AsBuilt.
TEST(UnseenErrors, LoadsOfTheDefaultFingerAreAFifthOffUntilItIsCalibrated) {
  DOUBLES_EQUAL(0.2, loadScale(), 1e-12);
  config.gauges.radius_m -= 0.1e-3;
  CHECK_TRUE(loadScale() > 0.2 * 1.01);
  config.calibration.load_error = 0.01;
  DOUBLES_EQUAL(0.2, loadScale(), 1e-12);
}

// 0.05 mm of 0.2 mm above the core; that it is enough is for closed_loop, AsBuilt.
TEST(UnseenErrors, ReadingsNearTheCoreAreUpToTwiceAsFarOffUntilItIsCalibrated) {
  DOUBLES_EQUAL(0.05, modelError(), 0);
  config.gauges.radius_m = config.finger.core_radius_m + 0.35e-3;
  CHECK_TRUE(modelError() > 0.05 && modelError() < 0.1);
  config.gauges.radius_m = config.finger.core_radius_m + 0.2e-3;
  DOUBLES_EQUAL(0.1, modelError(), 1e-12);
  config.tolerance.depth_m = 1e-5;
  DOUBLES_EQUAL(0.05, modelError(), 0);
  config.tolerance.depth_m = 5e-5;
  config.calibration.load_error = 0.01;
  DOUBLES_EQUAL(0.05, modelError(), 0);
}

TEST(UnseenErrors, ToleranceOfAnySizeIsTaken) {
  config.gauges.radius_m = 12e-3;
  config.tolerance.depth_m = 5e-3;
  DOUBLES_EQUAL(0.1, modelError(), 1e-12);
}

TEST(UnseenErrors, LoadsAreNoFurtherOffThanThemselves) {
  config.gauges.radius_m = config.finger.core_radius_m;
  DOUBLES_EQUAL(1, loadScale(), 0);
}

TEST(UnseenErrors, APerfectFingerHasNone) {
  config.gauges.model_error = 0;
  DOUBLES_EQUAL(0, loadScale(), 0);
  DOUBLES_EQUAL(0, modelError(), 0);
  DOUBLES_EQUAL(0, unseenErrors(config).place_m, 0);
  DOUBLES_EQUAL(0, unseenErrors(config).moment_m2, 0);
}
