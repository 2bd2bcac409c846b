#include "host/calibration/moved_zero.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/calibration/complaints.hpp"
#include "host/simulation/noise.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(MovedZero) {
  static constexpr int kGauges = 16;
  static constexpr double kNoise_strain = 6e-6;

  /// Noise, row by row, of which touches that are drawn, too, take four directions each.
  std::vector<ZeroEvidence> healthy(std::size_t rows, std::uint64_t seed) {
    const simulation::Noise draws(seed);
    std::vector<ZeroEvidence> evidence;
    for (std::size_t row = 0; row < rows; ++row) {
      Eigen::MatrixXd drawn(kGauges, kTouchUnknowns + 1);
      for (Eigen::Index i = 0; i < drawn.size(); ++i)
        drawn(i) = draws.at(100 * row + static_cast<std::uint64_t>(i), 0);
      const Eigen::HouseholderQR<Eigen::MatrixXd> qr(drawn.leftCols<kTouchUnknowns>());
      const Eigen::MatrixXd touch =
          qr.householderQ() * Eigen::MatrixXd::Identity(kGauges, Eigen::Index{kTouchUnknowns});
      const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(kGauges, kGauges) - touch * touch.transpose();
      evidence.push_back({row + 1, kNoise_strain, left * drawn.col(kTouchUnknowns), left});
    }
    return evidence;
  }
  void move(std::vector<ZeroEvidence> & rows, const MovedZero& zero) {
    for (std::size_t i = zero.firstRow - 1; i < zero.lastRow; ++i)
      rows[i].residual += zero.strain / kNoise_strain * rows[i].left.col(zero.gauge);
  }
  void checkNamed(const std::vector<MovedZero>& zeros) {
    auto rows = healthy(200, 1);
    for (const MovedZero& zero : zeros) move(rows, zero);
    const auto found = movedZeros(rows, kNoise_strain);
    LONGS_EQUAL(zeros.size(), found.size());
    for (std::size_t i = 0; i < zeros.size(); ++i) {
      LONGS_EQUAL(zeros[i].gauge, found[i].gauge);
      DOUBLES_EQUAL(static_cast<double>(zeros[i].firstRow), static_cast<double>(found[i].firstRow), 2);
      DOUBLES_EQUAL(static_cast<double>(zeros[i].lastRow), static_cast<double>(found[i].lastRow), 2);
      DOUBLES_EQUAL(zeros[i].strain, found[i].strain, kNoise_strain);
    }
  }
};

TEST(MovedZero, IsNamedWithItsRowsAndShiftWhereverTheyAre) {
  checkNamed({{3, 1, 20, 40e-6}});
  checkNamed({{3, 101, 120, -40e-6}});
  checkNamed({{3, 181, 200, 40e-6}});
}

TEST(MovedZero, OfOneGaugeNamesNoOther) { checkNamed({{3, 101, 160, 2e-3}}); }

TEST(MovedZero, OfSeveralGaugesInTheSameRowsNamesAllOfThem) {
  checkNamed({{3, 101, 160, 2e-4}, {4, 101, 160, 60e-6}, {5, 81, 130, -80e-6}});
}

TEST(MovedZero, ThatMovedUpAndLaterDownIsNamedTwice) {
  checkNamed({{3, 21, 50, 60e-6}, {3, 101, 140, -90e-6}});
}

TEST(MovedZero, OfLessThanThreeNoisesIsNone) {
  auto rows = healthy(200, 1);
  move(rows, {3, 101, 160, 2 * kNoise_strain});
  LONGS_EQUAL(0, movedZeros(rows, kNoise_strain).size());
}

// One session in a thousand is the bound; of these, none.
TEST(MovedZero, NoiseNamesNone) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed)
    LONGS_EQUAL(0, movedZeros(healthy(100, seed), kNoise_strain).size());
  LONGS_EQUAL(0, movedZeros({}, kNoise_strain).size());
}

TEST(MovedZero, JunkNamesNone) {
  for (const std::size_t every : {1U, 10U}) {  // forty rows in a row, then here and there
    auto rows = healthy(400, every);
    const auto junk = healthy(40, 99);
    for (std::size_t i = 0; i < junk.size(); ++i)
      rows[every * i].residual = rows[every * i].left * (100 * junk[i].residual);
    LONGS_EQUAL(0, movedZeros(rows, kNoise_strain).size());
  }
}

// 50 microstrain at one gauge, and the touch fitted to what it reads then.
TEST(MovedZero, LeavesItsColumnOnceTheTouchSuits) {
  const Drawing drawing{config::FingerConfig{}};
  const RingResponse ring(drawing, Eigen::VectorXd::Zero(drawing.unknowns()),
                          RingResponse::lastHarmonic(drawing));
  const TouchState touch(1, 20, 5, 5e-3);
  TouchData data{ring.readings(touch), kNoise_strain, {}};
  data.readings[4] += 50e-6;
  const auto evidence = zeroEvidence(7, ring, data, refineTouch(ring, data, touch).touch);
  const Eigen::VectorXd expected = 50e-6 / kNoise_strain * evidence.left.col(4);
  LONGS_EQUAL(7, evidence.row);
  CHECK_COMPARE(expected.norm(), >, 1);
  CHECK_COMPARE((evidence.residual - expected).norm(), <, 0.05 * expected.norm());
}

TEST(MovedZero, WithMostOfTheRowsIsRefusedByItsGauge) {
  const std::vector<MovedZero> moved{{3, 101, 160, 60e-6}};
  requireStill(moved, 0.39);
  requireStill({}, 1);
  try {
    requireStill(moved, 0.41);
    FAIL("accepted");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS(
        "gauge 3 reads 60 microstrain more in rows 101 to 160 than in the others; 41 % of the rows",
        failure.what());
  }
}
