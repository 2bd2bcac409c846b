#include "host/bench/error_statistics.hpp"

#include <cmath>

#include "host/bench/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(ErrorStatistics) {
  const config::FingerConfig perfect = perfectFinger();

  static ErrorStatistics touched(const config::FingerConfig& actual, const config::FingerConfig& told,
                                 double load, std::uint64_t seed = 8) {
    ErrorStatistics statistics;
    Trial(actual, told, seed).touchAnywhere(load, 300, statistics);
    return statistics;
  }
  static config::FingerConfig ofWidth(double width_m) {
    config::FingerConfig finger = perfectFinger();
    finger.contact.width_m = width_m;
    return finger;
  }
};

// The bound at 30 N/m and the default noise is 7 um RMS of arc; twice that is broken.
TEST(ErrorStatistics, AFirmTouchIsSeenAndFoundToTheBound) {
  const ErrorStatistics firm = touched(perfect, perfect, 30);
  LONGS_EQUAL(300, firm.contacts);
  LONGS_EQUAL(0, firm.unnoticed + firm.uncertain + firm.wrong);
  CHECK(firm.arc_mm.rms() > 0.002 && firm.arc_mm.rms() < 0.015);
  CHECK(firm.normal_n_per_m.rms() < 0.1);
  CHECK(firm.tangential_n_per_m.rms() < 0.1);
}

TEST(ErrorStatistics, AFaintTouchGoesUnnoticed) {
  const ErrorStatistics faint = touched(perfect, perfect, 0.01);
  LONGS_EQUAL(faint.contacts, faint.unnoticed);
}

// A line fitted to a contact 1 mm wide is 42 um off; with the width fitted the bound is 7 um, known 5 um.
TEST(ErrorStatistics, AWrongWidthCostsMuchMoreThanOneThatIsNotKnown) {
  const double known = touched(ofWidth(1e-3), ofWidth(1e-3), 30).arc_mm.rms();
  const double fitted = touched(ofWidth(1e-3), perfect, 30).arc_mm.rms();
  const ErrorStatistics wrong = touched(ofWidth(1e-3), ofWidth(0), 30);
  CHECK(known < fitted && fitted < 2 * known);
  CHECK(wrong.uncertain > 150 || wrong.arc_mm.rms() > 3 * fitted);
}

TEST(ErrorStatistics, TheSameSeedGivesTheSameErrors) {
  DOUBLES_EQUAL(touched(perfect, perfect, 5).arc_mm.rms(), touched(perfect, perfect, 5).arc_mm.rms(), 0);
  CHECK(touched(perfect, perfect, 5).arc_mm.rms() != touched(perfect, perfect, 5, 9).arc_mm.rms());
}
