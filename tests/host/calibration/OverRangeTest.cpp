#include "host/config/over_range.hpp"

#include <vector>

#include "host/calibration/calibrate.hpp"
#include "host/study/calibration_session.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(OverRange) {
  static constexpr std::uint64_t seed = 11;
  config::FingerConfig config;
};

// Of a converter that covers 0.03, the readings of gauges whose zeros are off by 1 and by 2 % of that.
TEST(OverRange, IsAlsoWhatIsLeftOfFullScaleByTheZero) {
  config.gauges.full_scale_strain = 0.03;
  for (const double ceiling_strain : {0.0294, 0.0297, 0.03, 0.0303})
    CHECK_TRUE(config::isOverRange(config.gauges, ceiling_strain));
  CHECK_FALSE(config::isOverRange(config.gauges, 0.028));
}

TEST(OverRange, RowsThatAGaugeClipsBelowFullScaleAreToldAsSuch) {
  auto session = study::sessionOf(study::randomFinger(seed), {.touches = 80, .knownLoads = 0}, seed);
  const double ceiling_strain = 0.98 * session.finger.gauges.full_scale_strain;
  for (const int row : {20, 50}) {
    session.readings.row(row) *= 1.1 * ceiling_strain / session.readings.row(row).cwiseAbs().maxCoeff();
    session.readings.row(row) = session.readings.row(row).cwiseMin(ceiling_strain).cwiseMax(-ceiling_strain);
  }
  const auto result = calibrate(session.finger, {}, session.readings);
  LONGS_EQUAL(2, result.count(RowUse::kOverRange));
  for (const std::size_t row : {20u, 50u}) CHECK_TRUE(result.rows()[row].use == RowUse::kOverRange);
}
