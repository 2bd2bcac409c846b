#include "host/config/unseen_errors.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::config;

TEST_GROUP(UnseenErrors) {
  FingerConfig config;
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

TEST(UnseenErrors, LoadsAreNoFurtherOffThanThemselves) {
  config.gauges.radius_m = config.finger.core_radius_m;
  DOUBLES_EQUAL(1, loadScale(), 0);
}

TEST(UnseenErrors, APerfectFingerHasNone) {
  config.gauges.model_error = 0;
  DOUBLES_EQUAL(0, loadScale(), 0);
  DOUBLES_EQUAL(0, unseenErrors(config).place_m, 0);
  DOUBLES_EQUAL(0, unseenErrors(config).moment_m2, 0);
}
