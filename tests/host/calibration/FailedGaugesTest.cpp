#include "host/calibration/failed_gauges.hpp"

#include <algorithm>
#include <string>

#include "host/base/failure.hpp"
#include "host/calibration/calibrate.hpp"
#include "host/calibration/findings.hpp"
#include "host/calibration/row_use.hpp"
#include "host/study/calibration_session.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(FailedGauges) {
  using Kind = FailedGauge::Kind;
  static constexpr std::uint64_t kSeed = 11;
  static constexpr int kTouches = 60;
  study::Session session = study::sessionOf(study::randomFinger(kSeed), {.touches = kTouches}, kSeed);

  std::vector<FailedGauge> failed() const {
    return findFailedGauges(session.finger.gauges, session.readings);
  }
  std::string complaint() const {
    try {
      calibrate(session.finger, session.known, session.readings);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "accepted";
  }
  /// Noise of the config's about a strain.
  void quieten(int gauge, double strain) {
    const double noise_strain = session.finger.gauges.noise_strain;
    for (Eigen::Index row = 0; row < session.readings.rows(); ++row)
      session.readings(row, gauge) = strain + (row % 2 == 0 ? noise_strain : -noise_strain);
  }
};

TEST(FailedGauges, AreNoneOfAHealthyFinger) { LONGS_EQUAL(0, failed().size()); }

TEST(FailedGauges, OneThatReadsTheSameInAllRowsIsNamedFirst) {
  session.readings.col(5).setConstant(3e-4);
  STRCMP_EQUAL(
      "gauge 5 reads 300 microstrain in all 60 rows: it is dead or not connected: look for an open wire or "
      "joint",
      complaint().c_str());
}

TEST(FailedGauges, OneThatReadsNothingButNoiseIsNamed) {
  quieten(5, 3e-4);
  CHECK_TRUE(failed() == (std::vector<FailedGauge>{{Kind::kNoise, 5, failed().front().strain, kTouches}}));
  STRCMP_CONTAINS("gauge 5 reads 300 microstrain in all 60 rows, but for noise: it is dead",
                  complaint().c_str());
}

TEST(FailedGauges, SideBySideAreBothNamed) {
  quieten(6, 0);
  session.readings.col(7).setZero();
  LONGS_EQUAL(2, failed().size());
  STRCMP_CONTAINS("; gauge 7 reads 0 microstrain in all 60 rows: it is dead", complaint().c_str());
}

// Of which nobody knows whether anything touched them.
TEST(FailedGauges, AnArcThatWasNotTouchedHasNotFailed) {
  for (int gauge = 6; gauge < 12; ++gauge) quieten(gauge, 0);
  LONGS_EQUAL(0, failed().size());
  for (int gauge = 6; gauge < 12; ++gauge) session.readings.col(gauge).setZero();  // less noise than a code
  LONGS_EQUAL(0, failed().size());
}

TEST(FailedGauges, OneAtTheEndOfItsRangeIsNamedAsSuch) {
  session.readings.col(5).setConstant(-0.0299);
  STRCMP_CONTAINS("gauge 5 reads -29900 microstrain, the end of its range, in 60 rows: look at its bridge",
                  complaint().c_str());
}

TEST(FailedGauges, OneAtTheEndOfItsRangeInManyRowsIsNamed) {
  session.readings.col(5).head(35).setConstant(0.03);
  CHECK_TRUE(failed().front().kind == Kind::kAtEnd);
  LONGS_EQUAL(35, failed().front().rows);
}

TEST(FailedGauges, FewRowsTellNone) {
  session.readings.col(5).setZero();
  const Eigen::MatrixXd few = session.readings.topRows(10);
  LONGS_EQUAL(0, findFailedGauges(session.finger.gauges, few).size());
}

TEST(FailedGauges, TheGaugeThatIsAlwaysOverRangeIsNamedWithTheRowsThatAre) {
  const auto reason = [](const std::vector<int>& peakGauges) {
    std::vector<RowResult> rows;
    for (const int gauge : peakGauges) {
      rows.emplace_back().use = RowUse::kOverRange;
      rows.back().peakGauge = gauge;
    }
    return mendOfOverRange(rows);
  };
  STRCMP_CONTAINS("it is always gauge 3: look at its zero, its wires", reason({3, 3, 3}).c_str());
  STRCMP_EQUAL("press less", reason({3, 3, 4}).c_str());
  STRCMP_EQUAL("press less", reason({3, 3}).c_str());
}

TEST(FailedGauges, TheGaugeThatIsSometimesOverRangeIsNamedInTheReport) {
  session.readings.col(5).tail(4).setConstant(0.03);
  const auto left = rowsLeftOut(calibrate(session.finger, session.known, session.readings));
  const auto overRange = std::ranges::find(left, RowUse::kOverRange, &LeftOut::use);
  CHECK_TRUE(overRange != left.end());
  STRCMP_CONTAINS("over range: it is always gauge 5: ", overRange->reason.c_str());
}
