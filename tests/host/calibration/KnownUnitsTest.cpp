#include "host/calibration/known_units.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/evidence/touched_ring.hpp"
#include "host/study/calibration_session.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(KnownUnits) {
  static constexpr std::uint64_t kSeed = 14;
  static constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
  const config::FingerConfig finger = study::randomFinger(kSeed);
  study::Session session =
      study::sessionOf(finger, {.touches = 40, .knownLoads = 5, .knownDirections = 5}, kSeed);

  std::string complaint() const {
    try {
      requireUnits(session.finger, session.known, session.readings);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "";
  }
  template <typename Change>
  void changeAngles(Change change) {
    for (KnownTouch& touch : session.known)
      if (touch.angle_deg) touch.angle_deg = change(*touch.angle_deg);
  }
  void scaleLoads(double by) {
    for (KnownTouch& touch : session.known)
      if (touch.normal_n_per_m) *touch.normal_n_per_m *= by;
  }
  /// Six touches all around, pushed this way and that; their tangential loads are said times `by`.
  void sayRubs(double by) {
    const evidence::TouchedRing ring{finger, kSeed};
    for (int row = 0; row < 6; ++row) {
      const double normal_n_per_m = 20, tangential_n_per_m = row % 2 == 0 ? 8 : -12,
                   angle_deg = 10 + 60 * row;
      session.readings.row(row) = ring.exact({.angle_rad = angle_deg / kDegreesPerRadian,
                                              .normal_n_per_m = normal_n_per_m,
                                              .tangential_n_per_m = tangential_n_per_m});
      session.known[static_cast<std::size_t>(row)] = {angle_deg, normal_n_per_m, by * tangential_n_per_m};
    }
  }
  /// Gauge i is where gauge i + `by` should be.
  void shiftRing(int by) {
    const Eigen::MatrixXd drawn = session.readings;
    for (int gauge = 0; gauge < 16; ++gauge) session.readings.col(gauge) = drawn.col((gauge + by) % 16);
  }
};

TEST(KnownUnits, ThoseThatAreMeantAreTaken) { STRCMP_EQUAL("", complaint().c_str()); }

TEST(KnownUnits, AnglesThatAreRadiansAreNamed) {
  changeAngles([](double angle_deg) { return angle_deg / kDegreesPerRadian; });
  STRCMP_CONTAINS("the angle_deg of touches.csv are radians by the readings", complaint().c_str());
}

TEST(KnownUnits, AnglesOnARingThatIsTurnedAreNoRadians) {
  for (int by = 1; by < 16; ++by) {
    shiftRing(1);
    STRCMP_EQUAL("", complaint().c_str());
  }
}

// A mark that is said to be where, in radians, it would be on a ring turned by five gauges.
TEST(KnownUnits, OneMarkTellsNoRadians) {
  const auto isMarked = [](const KnownTouch& touch) { return touch.angle_deg.has_value(); };
  const auto first = std::ranges::find_if(session.known, isMarked) - session.known.begin();
  const double said =
      (*session.known[static_cast<std::size_t>(first)].angle_deg + 5 * 22.5) / kDegreesPerRadian;
  for (std::size_t row = 0; row < session.known.size(); ++row)
    if (isMarked(session.known[row]))
      session.readings.row(static_cast<Eigen::Index>(row)) = session.readings.row(first).eval();
  changeAngles([&](double) { return std::remainder(said, 2 * std::numbers::pi); });
  for (int by = 1; by < 16; ++by) {
    shiftRing(1);
    STRCMP_EQUAL("", complaint().c_str());
  }
}

TEST(KnownUnits, TangentialLoadsOfTheOtherSignAreNamed) {
  sayRubs(1);
  STRCMP_EQUAL("", complaint().c_str());
  sayRubs(-1);
  STRCMP_CONTAINS("the tangential_n_per_m of touches.csv push the other way than the readings say",
                  complaint().c_str());
}

TEST(KnownUnits, OneTangentialLoadOfTheRightSignIsEnough) {
  sayRubs(-1);
  *session.known[3].tangential_n_per_m *= -1;
  STRCMP_EQUAL("", complaint().c_str());
}

TEST(KnownUnits, GaugesThatAreAllWiredBackwardsAreNoWrongSign) {
  sayRubs(1);
  session.readings *= -1;
  STRCMP_EQUAL("", complaint().c_str());
}

// Its touches seem to push the other way, too.
TEST(KnownUnits, ARingThatIsWiredTheOtherWayRoundIsNoWrongSign) {
  sayRubs(1);
  const Eigen::MatrixXd drawn = session.readings;
  for (int gauge = 0; gauge < 16; ++gauge) session.readings.col(gauge) = drawn.col((16 - gauge) % 16);
  STRCMP_EQUAL("", complaint().c_str());
}

TEST(KnownUnits, LoadsOfAnotherUnitAreNamed) {
  scaleLoads(finger.finger.length_m);  // newtons
  STRCMP_CONTAINS("they must be newtons per metre of its length (finger.length_m = 0.02)",
                  complaint().c_str());
  scaleLoads(1 / finger.finger.length_m / finger.finger.length_m);
  STRCMP_CONTAINS("they must be newtons per metre", complaint().c_str());
}

TEST(KnownUnits, LoadsOfASoftOrStiffFingerAreTaken) {
  scaleLoads(3);
  STRCMP_EQUAL("", complaint().c_str());
  scaleLoads(1.0 / 9);
  STRCMP_EQUAL("", complaint().c_str());
}

// Of faint touches it makes firm ones, which no touch explains.
TEST(KnownUnits, AZeroThatIsFarOffIsNotTakenForAUnit) {
  session = study::sessionOf(
      finger, {.touches = 40, .knownLoads = 5, .knownDirections = 5, .ranges = {.load_n_per_m = {1, 2}}},
      kSeed);
  session.readings.col(3).array() += 0.02;
  STRCMP_EQUAL("", complaint().c_str());
}

TEST(KnownUnits, RowsThatSayNoLoadDoNotCount) {
  for (std::size_t row = 10; row < 30; ++row) session.known[row] = {{}, 0.0, {}};
  STRCMP_EQUAL("", complaint().c_str());
}
