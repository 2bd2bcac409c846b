#include "host/config/ring_spacing.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::config;

TEST_GROUP(RingSpacing) {
  FingerConfig config;

  void checkSpacing(RingSpacing expected) {
    LONGS_EQUAL(static_cast<int>(expected), static_cast<int>(spacingOf(config)));
  }
};

// 2 pi 12.7 / 16 = 4.987 mm at the surface, 3.3 mm above the gauges.
TEST(RingSpacing, OfTheDefaultFingerIsAPitchOverTheDepth) {
  DOUBLES_EQUAL(1.5113, widestGapInDepths(config), 1e-4);
  checkSpacing(RingSpacing::kDense);
}

TEST(RingSpacing, FewerOrShallowerGaugesAreLooseThenSparse) {
  config.gauges.count = 14;  // 1.727
  checkSpacing(RingSpacing::kLoose);
  config.gauges.count = 12;  // 2.015
  checkSpacing(RingSpacing::kSparse);
  config.gauges.count = 32;
  config.gauges.radius_m = 11.2e-3;  // 1.662
  checkSpacing(RingSpacing::kLoose);
}

TEST(RingSpacing, IsLooseInRubberThatGivesWayInVolume) {
  config.finger.poisson_ratio = 0.48;
  checkSpacing(RingSpacing::kDense);
  config.finger.poisson_ratio = 0.479;
  checkSpacing(RingSpacing::kLoose);
}

TEST(RingSpacing, IsThatOfTheWidestGapWhereverItIs) {
  for (int moved = 0; moved < 16; ++moved) {
    config.gauges.angles_deg.clear();
    for (int i = 0; i < 16; ++i) config.gauges.angles_deg.push_back(10 + i * 22.5 + (i == moved ? 9 : 0));
    DOUBLES_EQUAL(1.5113 * 31.5 / 22.5, widestGapInDepths(config), 1e-3);
    checkSpacing(RingSpacing::kSparse);
  }
}
