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

// The strongest of so many are alike; fitted to those alone, this finger's ring explained its one known
// direction better the other way round.
TEST(Wiring, AHealthyRingThatWasTouchedThousandsOfTimesIsNotBlamed) {
  seed = 18;
  session = study::sessionOf(study::randomFinger(seed), {.touches = 3000}, seed);
  const auto found = faults();
  if (!found.empty()) FAIL(textOf(found.front()).c_str());
}

TEST(Wiring, ATenthOfJunkIsNoFault) {
  session =
      study::sessionOf(study::randomFinger(seed), {.touches = 150, .knownDirections = 2, .junk = 0.1}, seed);
  LONGS_EQUAL(0, faults().size());
}

// As when the finger warms up, or is put down, late in a short session.
TEST(Wiring, AZeroThatMovesIsNoFault) {
  constexpr int kTouches = 80, kMoved = kTouches / 4;
  for (seed = 200; seed < static_cast<std::uint64_t>(200 + randomCases(16)); ++seed) {
    session = study::sessionOf(study::randomFinger(seed), {.touches = kTouches, .knownDirections = 2}, seed);
    session.readings.bottomRows(kMoved).col(static_cast<Eigen::Index>(seed % 16)).array() += 2e-4;
    const auto found = faults();
    if (!found.empty()) FAIL(textOf(found.front()).c_str());
  }
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
  checkOnly({Kind::kGlued, 5, 6});
}

TEST(Wiring, TwoFaultsAreBothNamed) {
  session.readings.col(7) *= -1;
  session.readings.col(1).swap(session.readings.col(2));
  LONGS_EQUAL(2, faults().size());
}

// A fitted ring sees a touch within a degree: a shifted and a reversed ring see it ten degrees apart where it
// is a quarter of a pitch from a gauge.
TEST(Wiring, OneDirectionAwayFromGaugesTellsAShiftFromAReversal) {
  const evidence::TouchRanges quarter{
      .load_n_per_m = {20, 40}, .lean_deg = {-20, 20}, .offset_pitch = {0.25, 0.25}, .width_m = {1e-3, 2e-3}};
  for (seed = 40; seed < static_cast<std::uint64_t>(40 + randomCases(4)); ++seed) {
    const auto known =
        study::sessionOf(study::randomFinger(seed), {.touches = 6, .ranges = quarter}, 1000 + seed);
    for (const bool isReversed : {false, true}) {
      session = healthy();
      for (KnownTouch& each : session.known) each.angle_deg.reset();
      session.known[5] = known.known[5];
      session.readings.row(5) = known.readings.row(5);
      std::vector<int> places;
      for (int i = 0; i < 16; ++i) places.push_back((isReversed ? 18 - i : 2 + i) % 16);
      rewire(places);
      checkOnly({isReversed ? Kind::kReversed : Kind::kShifted, 0, 2});
    }
  }
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

TEST(Wiring, OfManyKnownDirectionsSomeTellATurn) {
  session = study::sessionOf(study::randomFinger(seed), {.touches = 150, .knownDirections = 100}, seed);
  LONGS_EQUAL(0, faults().size());
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
