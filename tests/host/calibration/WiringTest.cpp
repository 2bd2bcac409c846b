#include "host/calibration/wiring.hpp"

#include <string>
#include <vector>

#include "host/base/angles.hpp"
#include "host/study/calibration_session.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;
using Kind = WiringFault::Kind;

TEST_GROUP(Wiring) {
  std::uint64_t seed = 31;
  study::Session session = healthy();

  study::Session healthy() const {
    return study::sessionOf(study::randomFinger(seed), {.touches = 150, .knownDirections = 2}, seed);
  }
  std::vector<WiringFault> faults() const {
    return findWiringFaults(session.finger, session.known, session.readings, study::kExactlyKnown);
  }
  void checkOnly(const WiringFault& fault) const {
    const auto found = faults();
    LONGS_EQUAL(1, found.size());
    STRCMP_EQUAL(textOf(fault).c_str(), textOf(found.front()).c_str());
  }
  /// Rows as a ring would read them whose gauge i is where gauge places[i] should be.
  void rewire(const std::vector<int>& places) {
    const Eigen::MatrixXd drawn = session.readings;
    for (int i = 0; i < 16; ++i) session.readings.col(i) = drawn.col(places[static_cast<std::size_t>(i)]);
  }
};

TEST(Wiring, HealthyFingersAreNotBlamed) {
  for (seed = 100; seed < static_cast<std::uint64_t>(100 + randomCases(8)); ++seed) {
    session = healthy();
    LONGS_EQUAL(0, faults().size());
  }
}

TEST(Wiring, ATenthOfJunkIsNoFault) {
  session =
      study::sessionOf(study::randomFinger(seed), {.touches = 150, .knownDirections = 2, .junk = 0.1}, seed);
  LONGS_EQUAL(0, faults().size());
}

TEST(Wiring, ASwappedPairIsNamed) {
  for (const auto& [a, b] : {std::pair{3, 4}, {0, 15}, {2, 9}}) {
    session = healthy();
    session.readings.col(a).swap(session.readings.col(b));
    checkOnly({Kind::kSwapped, a, b});
  }
}

TEST(Wiring, AWrongSignIsNamed) {
  session.readings.col(7) *= -1;
  checkOnly({Kind::kSign, 7});
}

TEST(Wiring, WrongSignsOfAllAreOneFault) {
  session.readings *= -1;
  checkOnly({Kind::kAllSigns});
}

TEST(Wiring, ADeadGaugeIsNamed) {
  session.readings.col(5) *= 0.001;
  checkOnly({Kind::kDead, 5});
}

TEST(Wiring, AGaugeThatReadsItsNeighboursStrainIsNamed) {
  session.readings.col(5) = session.readings.col(6);
  const auto found = faults();
  LONGS_EQUAL(1, found.size());
  CHECK_TRUE(found.front() == (WiringFault{Kind::kGlued, 5, 6}) ||
             found.front() == (WiringFault{Kind::kGlued, 6, 5}));
}

TEST(Wiring, TwoFaultsAreBothNamed) {
  session.readings.col(7) *= -1;
  session.readings.col(1).swap(session.readings.col(2));
  LONGS_EQUAL(2, faults().size());
}

TEST(Wiring, ARingThatIsShiftedIsNamed) {
  std::vector<int> places;
  for (int i = 0; i < 16; ++i) places.push_back((i + 3) % 16);
  rewire(places);
  checkOnly({Kind::kShifted, 0, 3});
}

TEST(Wiring, ARingThatIsReversedIsNamed) {
  std::vector<int> places;
  for (int i = 0; i < 16; ++i) places.push_back((16 - i) % 16);
  rewire(places);
  checkOnly({Kind::kReversed, 0, 0});
}

// A touch over a gauge: a ring turned by twice its place explains it as well as a reversed one.
TEST(Wiring, OneDirectionAtAGaugeDoesNotTellAShiftFromAReversal) {
  const evidence::TouchRanges overGauges{
      .load_n_per_m = {10, 40}, .offset_pitch = {0, 0}, .width_m = {1e-3, 2e-3}};
  session = study::sessionOf(study::randomFinger(seed), {.touches = 150, .ranges = overGauges}, seed);
  std::vector<int> places;
  for (int i = 0; i < 16; ++i) places.push_back((16 - i) % 16);
  rewire(places);
  checkOnly({Kind::kTurnUnclear});
}
