#include "host/calibration/known_units.hpp"

#include <numbers>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
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

// 2 radians are 114.6 degrees: that is where five gauges further round a mark at 2 degrees seems to be.
TEST(KnownUnits, OneMarkTellsNoRadians) {
  changeAngles([](double) { return 2.0; });
  for (int by = 1; by < 16; ++by) {
    shiftRing(1);
    STRCMP_EQUAL("", complaint().c_str());
  }
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

// With all signs reversed no touch explains the readings.
TEST(KnownUnits, WiresAreNotTakenForUnits) {
  session.readings *= -1;
  STRCMP_EQUAL("", complaint().c_str());
}

TEST(KnownUnits, RowsThatSayNoLoadDoNotCount) {
  for (std::size_t row = 10; row < 30; ++row) session.known[row] = {{}, 0.0, {}};
  STRCMP_EQUAL("", complaint().c_str());
}
