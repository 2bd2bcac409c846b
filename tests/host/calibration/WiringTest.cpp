#include "host/calibration/wiring.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <span>
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
  /// Of gauge i, where it lies; for rewire().
  static std::vector<int> shifted(int by) {
    std::vector<int> places;
    for (int i = 0; i < 16; ++i) places.push_back((by + i) % 16);
    return places;
  }
  static std::vector<int> reversed(int by) {
    std::vector<int> places;
    for (int i = 0; i < 16; ++i) places.push_back((by + 16 - i) % 16);
    return places;
  }
  /// The last row of known direction.
  std::size_t marked() const {
    std::size_t row = session.known.size() - 1;
    while (!session.known[row].angle_deg) --row;
    return row;
  }
  std::vector<int> untouched() const { return untouchedGauges(session.finger.gauges, session.readings); }
  /// Of a session whose directions are all known, the touches between two of them.
  void keepTouches(double from_deg, double to_deg) {
    const auto all = study::sessionOf(study::randomFinger(seed),
                                      {.touches = 150,
                                       .knownLoads = 0,
                                       .knownDirections = 150,
                                       .ranges = {.load_n_per_m = {15, 40}, .width_m = {1e-3, 2e-3}}},
                                      seed);
    std::vector<int> rows;
    for (int row = 0; row < 150; ++row) {
      const double angle_deg = *all.known[static_cast<std::size_t>(row)].angle_deg;
      if (angle_deg > from_deg && angle_deg < to_deg) rows.push_back(row);
    }
    session.readings = all.readings(rows, Eigen::all);
    session.known.clear();
  }
  /// Of a ring whose gauges are drawn up to so much off even places.
  study::Session uneven(double most_deg, int knownDirections) const {
    config::FingerConfig finger = study::randomFinger(seed);
    for (int i = 0; i < 16; ++i)
      finger.gauges.angles_deg.push_back(5 + 22.5 * i + most_deg * std::cos(i * i));
    return study::sessionOf(finger, {.touches = 150, .knownDirections = knownDirections}, seed);
  }
  void checkTurnsAreFound(const study::Session& wiredAsDrawn) {
    session = wiredAsDrawn;
    LONGS_EQUAL(0, faults().size());
    rewire(shifted(5));
    checkOnly({Kind::kShifted, 0, 5});
    session = wiredAsDrawn;
    rewire(reversed(5));
    checkOnly({Kind::kReversed, 0, 5});
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

TEST(Wiring, GaugesThatNoTouchIsNearAreNamed) {
  CHECK_TRUE(untouched().empty());
  keepTouches(40, 185);
  const std::vector<int> expected{0, 10, 11, 12, 13, 14, 15};
  CHECK_TRUE(untouched() == expected);
}

TEST(Wiring, RowsWithoutATouchAreNearNoGauge) {
  session.readings *= 1e-3;
  LONGS_EQUAL(16, untouched().size());
}

// It reads most in no row; those beside it do.
TEST(Wiring, ADeadGaugeIsNotUntouched) {
  session.readings.col(5) *= 0.001;
  CHECK_TRUE(untouched().empty());
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

TEST(Wiring, RadialGaugesThatAreDrawnAsHoopGaugesAreToldForTheirComponentToo) {
  session.finger.gauges.component = StrainComponent::kHoop;
  checkOnly({Kind::kAllSigns});
  STRCMP_CONTAINS("; or gauges.component is wrong", textOf(faults().front()).c_str());
}

TEST(Wiring, ADeadGaugeIsNamed) {
  session.readings.col(5) *= 0.001;
  checkOnly({Kind::kDead, 5});
}

TEST(Wiring, AGaugeThatReadsItsNeighboursStrainIsNamed) {
  session.readings.col(5) = session.readings.col(6);
  checkOnly({Kind::kGlued, 5, 6});
}

TEST(Wiring, AGaugeWhoseZeroIsOffIsToldForThatWhereUntouchedRowsShowIt) {
  session.readings.conservativeResize(155, Eigen::NoChange);
  session.readings.bottomRows(5).setZero();
  session.known.resize(155, {std::nullopt, 0, 0});
  session.readings.col(6).array() += 1e-3;
  const auto found = faults();
  LONGS_EQUAL(1, found.size());
  STRCMP_EQUAL(
      "gauge 6 reads 1000 microstrain where nothing touches the finger: its zero is off: tare, and touch the "
      "finger anew",
      textOf(found.front()).c_str());
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
      rewire(isReversed ? reversed(2) : shifted(2));
      checkOnly({isReversed ? Kind::kReversed : Kind::kShifted, 0, 2, 6});
    }
  }
}

TEST(Wiring, ARingThatIsShiftedIsNamed) {
  rewire(shifted(3));
  checkOnly({Kind::kShifted, 0, 3});
}

TEST(Wiring, ARingThatIsReversedIsNamed) {
  rewire(reversed(0));
  checkOnly({Kind::kReversed, 0, 0});
}

// A mark noted wrong: the right one speaks against any turn that explains it.
TEST(Wiring, DirectionsThatNoTurnExplainsAreNoFault) {
  constexpr std::array kWrong_deg{-22.5, 90.0, -90.0, 45.0};
  for (const double wrong_deg : std::span(kWrong_deg).first(kSanitized ? 1 : kWrong_deg.size())) {
    session = healthy();
    *session.known[marked()].angle_deg += wrong_deg;
    const auto found = faults();
    if (!found.empty()) FAIL(textOf(found.front()).c_str());
  }
}

TEST(Wiring, OneWrongMarkOfEightHidesNoReversedRing) {
  session = study::sessionOf(study::randomFinger(seed), {.touches = 150, .knownDirections = 8}, seed);
  rewire(reversed(0));
  *session.known[marked()].angle_deg += 90;
  checkOnly({Kind::kReversed, 0, 0});
}

TEST(Wiring, WhereOnlyOneMarkTellsATurnItMayBeWrong) {
  session = study::sessionOf(study::randomFinger(seed), {.touches = 150}, seed);
  *session.known[marked()].angle_deg += 45;
  const auto found = faults();
  LONGS_EQUAL(1, found.size());
  LONGS_EQUAL(marked() + 1, found.front().onlyMark);
  STRCMP_CONTAINS("; or angle_deg of touch ", textOf(found.front()).c_str());
  STRCMP_CONTAINS(", the only one that is known, is wrong", textOf(found.front()).c_str());
  CHECK_FALSE(isOfFinger(found.front()));
}

TEST(Wiring, KnownDirectionsTellHowAnUnevenRingLies) { checkTurnsAreFound(uneven(1, 2)); }

// Where no mark is known that could be wrong, none is blamed.
TEST(Wiring, ARingThatIsDrawnDegreesOffEvenPlacesTellsItselfHowItLies) { checkTurnsAreFound(uneven(2.5, 0)); }

TEST(Wiring, OneMarkIsNotInDoubtWhereTheShapeTellsATurn) { checkTurnsAreFound(uneven(2.5, 1)); }

TEST(Wiring, TheShapeTellsATurnThatAMarkDenies) {
  session = uneven(2.5, 1);
  *session.known[marked()].angle_deg += 40;
  rewire(shifted(5));
  checkOnly({Kind::kShifted, 0, 5});
}

TEST(Wiring, AHalfOfTheRingWithMostOfTheGaugesIsNoFault) {
  config::FingerConfig finger = study::randomFinger(seed);
  for (int i = 0; i < 16; ++i)
    finger.gauges.angles_deg.push_back(10 + 22.5 * i + 15 * std::sin(std::numbers::pi / 8 * i));
  session = study::sessionOf(finger, {.touches = 150}, seed);
  LONGS_EQUAL(0, faults().size());
  rewire(shifted(5));
  CHECK_TRUE(!faults().empty());
}

TEST(Wiring, OfManyKnownDirectionsSomeTellATurn) {
  session = study::sessionOf(study::randomFinger(seed), {.touches = 150, .knownDirections = 100}, seed);
  LONGS_EQUAL(0, faults().size());
  rewire(reversed(0));
  checkOnly({Kind::kReversed, 0, 0});
}

// A touch over a gauge: a ring turned by twice its place explains it as well as a reversed one.
TEST(Wiring, OneDirectionAtAGaugeDoesNotTellAShiftFromAReversal) {
  const evidence::TouchRanges overGauges{
      .load_n_per_m = {10, 40}, .offset_pitch = {0, 0}, .width_m = {1e-3, 2e-3}};
  session = study::sessionOf(study::randomFinger(seed), {.touches = 150, .ranges = overGauges}, seed);
  rewire(reversed(0));
  checkOnly({Kind::kTurnUnclear, 0, 0, static_cast<int>(marked()) + 1});
  CHECK_FALSE(isOfFinger({Kind::kTurnUnclear}));
  CHECK_TRUE(isOfFinger({Kind::kReversed}));
}
