#include "host/bench/error_statistics.hpp"

#include <cmath>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(ErrorStatistics){static ErrorStatistics touched(const config::FingerConfig& actual,
                                                           const config::FingerConfig& told, double load,
                                                           std::uint64_t seed = 8){ErrorStatistics statistics;
Trial(actual, told, seed).touchAnywhere(load, 300, statistics);
return statistics;
}
}
;

// The bound at 30 N/m and the default noise is 5 um RMS of arc; three times that is broken.
TEST(ErrorStatistics, AFirmTouchIsSeenAndFoundToTheBound) {
  const ErrorStatistics firm = touched({}, {}, 30);
  LONGS_EQUAL(300, firm.contacts);
  LONGS_EQUAL(0, firm.unnoticed + firm.uncertain + firm.wrong);
  CHECK(firm.arc_mm.rms() > 0.002 && firm.arc_mm.rms() < 0.015);
  CHECK(firm.normal_n_per_m.rms() < 0.1);
  CHECK(firm.tangential_n_per_m.rms() < 0.1);
}

TEST(ErrorStatistics, AFaintTouchGoesUnnoticed) {
  const ErrorStatistics faint = touched({}, {}, 0.01);
  LONGS_EQUAL(faint.contacts, faint.unnoticed);
}

TEST(ErrorStatistics, AWidthThatTheTablesDoNotKnowCostsAccuracy) {
  config::FingerConfig wide;
  wide.contact.width_m = 1e-3;
  CHECK(touched(wide, {}, 30).arc_mm.rms() > 3 * touched(wide, wide, 30).arc_mm.rms());
}

TEST(ErrorStatistics, TheSameSeedGivesTheSameErrors) {
  DOUBLES_EQUAL(touched({}, {}, 5).arc_mm.rms(), touched({}, {}, 5).arc_mm.rms(), 0);
  CHECK(touched({}, {}, 5).arc_mm.rms() != touched({}, {}, 5, 9).arc_mm.rms());
}
