#include <algorithm>
#include <set>
#include <string>
#include <tuple>

#include "host/bench/matrix/matrix_page.hpp"
#include "host/bench/matrix/matrix_rows.hpp"
#include "host/bench/matrix/session.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(Matrix) {
  static constexpr int kTouches = 30;
  static constexpr std::uint64_t kSeed = 12;

  static Disturbance firmTouches() {
    Disturbance firm;
    firm.touches.load_n_per_m = {30, 30};
    return firm;
  }
  static Tally tally(const Disturbance& disturbance) { return tallyOf(disturbance, kTouches, kSeed); }
};

TEST(Matrix, FirmTouchesOfAPerfectFingerAreAllLocated) {
  const Tally firm = tally(firmTouches());
  LONGS_EQUAL(kTouches, firm.touches);
  LONGS_EQUAL(kTouches, firm.located);
  LONGS_EQUAL(0, firm.silent + firm.beyond + firm.flagged + firm.blamed + firm.missed + firm.ghosts);
}

TEST(Matrix, ATouchBelowTheGateIsMissed) {
  Disturbance faint;
  faint.touches.load_n_per_m = {0.01, 0.01};
  LONGS_EQUAL(kTouches, tally(faint).missed);
}

// Twice the loads in all gauges is a touch of twice the load: nothing tells the firmware.
TEST(Matrix, LoadsThatAreFarOffAreBeyondTheirSigmasThoughThePlaceIsRight) {
  Disturbance doubled = firmTouches();
  doubled.touches.load_n_per_m = {15, 15};
  doubled.actual.calibration.gain.assign(16, 2.0);
  const Tally twice = tally(doubled);
  LONGS_EQUAL(kTouches, twice.located);
  LONGS_EQUAL(kTouches, twice.beyond);
}

// All gauges are two further round than the tables have them.
TEST(Matrix, APlaceThatIsPitchesOffIsSilentlyWrong) {
  Disturbance turned = firmTouches();
  turned.actual.gauges.first_angle_deg = 45;
  LONGS_EQUAL(kTouches, tally(turned).silent);
  LONGS_EQUAL(0, tally(turned).located);
}

// 6 mm on, more than a pitch, where the touch is judged; of loads from a half to one and a half times their
// mean.
TEST(Matrix, WhatMovesIsJudgedByWhatItIsInTheLastSampleSet) {
  Disturbance slides = firmTouches();
  slides.motion.slides_m_per_s = 0.05;
  LONGS_EQUAL(kTouches, tally(slides).located);
  LONGS_EQUAL(0, tally(slides).beyond);
  Disturbance trembles = firmTouches();
  trembles.motion = {.trembles_hz = 10, .trembling = 0.5};
  LONGS_EQUAL(kTouches, tally(trembles).located);
  LONGS_EQUAL(0, tally(trembles).beyond);
}

// Second answers come and go with such noise: 0.9 % of the touches were told in the wrong one, unflagged,
// while an answer forgot the other as soon as one sample set showed one of them only.
TEST(Matrix, OfTwoAnswersThatNoiseMixesUpTheWrongOneIsFlagged) {
  Disturbance noisy;
  noisy.actual.gauges.noise_strain *= 10;
  const Tally heard = tallyOf(noisy, 6000, kSeed);
  CHECK_COMPARE(heard.silent, <=, 4);     // 5 of 18,000 touches of three seeds
  CHECK_COMPARE(heard.located, >, 1900);  // of those that are not weak beside such noise, two in three
}

TEST(Matrix, ATouchThatCountsAsUntouchedIsAGhost) {
  Disturbance moved = firmTouches();
  moved.zeroSpread_strain = 1e-3;
  moved.isUntouched = true;
  LONGS_EQUAL(kTouches, tally(moved).ghosts);
  Disturbance still = firmTouches();
  still.isUntouched = true;
  LONGS_EQUAL(0, tally(still).ghosts);
}

TEST(Matrix, BothContactsOfAPairHaveToBeLocated) {
  Disturbance pair = firmTouches();
  pair.second = SecondContact{5, 1};
  pair.touched_sets = kLongestSearch_sets;
  CHECK(tally(pair).located > kTouches / 2);
  pair.second->later_sets = pair.touched_sets;  // it never comes
  LONGS_EQUAL(0, tally(pair).located);
}

TEST(Matrix, AFailedGaugeDisturbsAndIsNotCountedAsBlamed) {
  Disturbance atRail = firmTouches();
  atRail.failure = bench::Failure::kOpen;
  const Tally failed = tally(atRail);
  LONGS_EQUAL(0, failed.blamed);
  LONGS_EQUAL(kTouches, failed.touches);
}

TEST(Matrix, TheSameSeedGivesTheSameTally) {
  Disturbance noisy;
  noisy.actual.gauges.noise_strain *= 10;
  const auto figures = [&](std::uint64_t seed) {
    const Tally tally = tallyOf(noisy, 100, seed);
    return std::tuple(tally.silent, tally.beyond, tally.flagged, tally.missed, tally.located, tally.ghosts);
  };
  CHECK(figures(1) == figures(1));
  CHECK(figures(1) != figures(2));
}

TEST(Matrix, EveryRowHasANameOfItsOwn) {
  std::set<std::string> names;
  for (const Disturbance& row : matrixRows()) names.insert(row.name);
  LONGS_EQUAL(matrixRows().size(), names.size());
  CHECK(names.size() > 100);
}

TEST(Matrix, ThePageHasTheWorstRowFirst) {
  const std::string page =
      matrixPage({{"good", {.touches = 200, .located = 200}},
                  {"flagged", {.touches = 200, .flagged = 200}},
                  {"bad", {.touches = 200, .silent = 3, .beyond = 10, .flagged = 100, .located = 50}}},
                 200, 7);
  STRCMP_CONTAINS("| bad | 1.5 % | 5 % | 50 % | 0 | 0 | 25 % | 0 | 200 |\n| flagged |", page.c_str());
  CHECK(page.find("| flagged |") < page.find("| good |"));
  STRCMP_CONTAINS("3 of 3 rows; 200 touches a row, fewer where they take seconds; seed 7.", page.c_str());
}

TEST(Matrix, ThePageLeavesTheMildestOfManyRowsToTheCsv) {
  std::vector<MatrixRow> rows(41, {"bad", {.touches = 200, .silent = 3}});
  rows[7] = {"mild", {.touches = 200, .located = 200}};
  const std::string page = matrixPage(rows, 200, 7);
  CHECK(page.find("| mild |") == std::string::npos);
  STRCMP_CONTAINS("40 of 41 rows;", page.c_str());
}
