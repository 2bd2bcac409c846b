#include "host/session/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tests/host/session/hands.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

TEST_GROUP(Thinning) {
  config::FingerConfig config;
  Hand hand{config};
  std::vector<Sample> samples;

  void add(const Eigen::VectorXd& strains, double period_s = 0.01) {
    samples.push_back({samples.empty() ? 0 : samples.back().time_s + period_s, strains});
  }
  void hold(double angle_deg, double normal_n_per_m, int sets, double tangential_n_per_m = 0) {
    for (int i = 0; i < sets; ++i) add(hand.touch(angle_deg, normal_n_per_m, tangential_n_per_m));
  }
  std::size_t kept() const {
    Thinner thinner(config);
    return static_cast<std::size_t>(std::ranges::count_if(
        samples, [&](const Sample& sample) { return thinner.take(sample) == Verdict::kKept; }));
  }
};

TEST(Thinning, ATouchThatIsHeldForSecondsIsOneRow) {
  hold(40, 20, 500);
  LONGS_EQUAL(1, kept());
}

TEST(Thinning, NothingIsKeptOfAFingerThatNothingTouches) {
  for (int i = 0; i < 200; ++i) add(hand.nothing());
  LONGS_EQUAL(0, kept());
}

// 72 deg/s for 5 s: at most a row every 40 ms, 125 in all; a stroke is nothing but new touches.
TEST(Thinning, AStrokeGivesARowEvery40Milliseconds) {
  for (int i = 0; i < 500; ++i) add(hand.touch(0.72 * i, 20));
  CHECK_COMPARE(kept(), >=, 100);
  CHECK_COMPARE(kept(), <=, 125);
}

TEST(Thinning, ALoadThatChangesQuicklyIsNotKept) {
  for (int i = 0; i < 8; ++i) add(hand.touch(40, 5 * std::pow(1.3, i)));  // 30/s
  LONGS_EQUAL(0, kept());
}

TEST(Thinning, ALoadThatChangesSlowlyIsKeptAgainAndAgain) {
  for (int i = 0; i < 200; ++i) add(hand.touch(40, 5 * std::pow(1.01, i)));  // 1/s
  CHECK_COMPARE(kept(), >=, 20);
}

TEST(Thinning, OfOnePlaceLoadAndLeanThereAreNotMoreThanEight) {
  for (int i = 0; i < 4000; ++i) add(hand.touch(40 + 0.5 * std::sin(0.01 * i), 20));
  CHECK_COMPARE(kept(), <=, 8);
  for (int i = 0; i < 4000; ++i) add(hand.touch(40 + 0.5 * std::sin(0.01 * i), 20, 12));
  CHECK_COMPARE(kept(), >, 8);
  CHECK_COMPARE(kept(), <=, 16);
}

TEST(Thinning, ReadingsBeyondTheRangeAreNotKept) {
  hold(0, 100, 100);  // full scale is 65 N/m over a gauge
  LONGS_EQUAL(0, kept());
}

TEST(Thinning, ReadingsThatTheZeroKeepsBelowFullScaleAreBeyondTheRangeToo) {
  Thinner thinner(config);
  Eigen::VectorXd strains = Eigen::VectorXd::Zero(config.gauges.count);
  strains[3] = -0.98 * config.gauges.full_scale_strain;
  CHECK(thinner.take({0, strains}) == Verdict::kOverRange);
}

TEST(Thinning, AfterAPauseTheFirstSetIsNotKept) {
  hold(40, 20, 1);
  add(hand.touch(90, 20), 10);
  LONGS_EQUAL(0, kept());
}

TEST(Thinning, RowsTenTimesASecondAreKept) {
  for (int i = 0; i < 20; ++i) add(hand.touch(5.0 * i, 20 + 0.1 * i), 0.1);
  CHECK_COMPARE(kept(), >=, 15);
}

TEST(Thinning, WhatWasRememberedIsNotKeptAgain) {
  hold(40, 20, 100);
  Thinner thinner(config);
  thinner.remember(hand.touch(40, 20));
  for (const Sample& sample : samples) CHECK(thinner.take(sample) != Verdict::kKept);
}

TEST(Thinning, NotARateButTimeCounts) {
  for (int i = 0; i < 500; ++i) add(hand.touch(0.72 * i, 20));
  const std::size_t slow = kept();
  samples.clear();
  for (int i = 0; i < 5000; ++i) add(hand.touch(0.072 * i, 20), 0.001);
  DOUBLES_EQUAL(static_cast<double>(slow), static_cast<double>(kept()), 12);
}
