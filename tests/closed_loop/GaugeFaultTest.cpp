// Gauges that fail: how soon the firmware names them, from the converter's codes on; and that it names none
// for what is not the gauges' fault. A perfect finger, model_error 0; touches of up to 3 mm.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>

#include "host/base/angles.hpp"
#include "host/evidence/touches.hpp"
#include "host/evidence/uniform.hpp"
#include "tests/closed_loop/sampled_finger.hpp"
#include "tests/closed_loop/touch_count.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using firmware::GaugeSet;

namespace {

enum class Kind { kNone, kDead, kOpen, kShort, kStuck };
constexpr std::array kKindNames{"healthy", "dead", "open", "short", "stuck"};
constexpr std::size_t kFaulty = 5;
constexpr GaugeSet kFaultySet = 1u << kFaulty;

constexpr int kRest = 30;               ///< sample sets between touches
constexpr int kTouch = kSetsPerSecond;  ///< and of a touch that is long enough for any search

/// Changes the codes as a failed gauge does; stuck at, or dead at, this code.
std::function<void(SampledFinger::Codes&)> fault(Kind kind, std::uint16_t held) {
  return [=](SampledFinger::Codes& codes) {
    if (kind == Kind::kDead || kind == Kind::kStuck) codes[kFaulty] = held;
    if (kind == Kind::kOpen) codes[kFaulty] = 0xFFF0;
    if (kind == Kind::kShort) codes[kFaulty] = 0;
  };
}

/// Sample sets of a touch and of the rest before it.
struct Rhythm {
  int touch = kTouch, rest = kRest;
};

/// What is said of places.
struct Told {
  bool right = true;     ///< each touch is told within half a pitch
  bool flagged = false;  ///< what is told may be wrong, or is said to be several contacts of one place
};

}  // namespace

TEST_GROUP(GaugeFault) {
  const config::FingerConfig config = [] {
    config::FingerConfig perfect;
    perfect.gauges.model_error = 0;
    return perfect;
  }();
  const std::unique_ptr<TableImage> tables = std::make_unique<TableImage>(tables::buildTableImage(config));
  const evidence::TouchedRing ring{config, 401};
  const evidence::TouchDraws touches{config.gauges, {.load_n_per_m = {10, 50}, .width_m = {0, 3e-3}}, 402};

  /// Each with noise of its own.
  std::unique_ptr<SampledFinger> finger(int trial) const {
    return std::make_unique<SampledFinger>(*tables, ring, static_cast<std::uint64_t>(trial) << 32);
  }

  Told told(const SampledFinger& finger, std::span<const simulation::Touch> truth) const {
    const double half_rad = std::numbers::pi / config.gauges.count;
    const auto answers = finger.answers();
    Told told{.flagged = answers.size() < truth.size() && finger.observation().several};
    for (const evidence::Answer& answer : answers) told.flagged |= answer.isFlagged;
    for (const simulation::Touch& touch : truth)
      told.right &= std::any_of(answers.begin(), answers.end(), [&](const evidence::Answer& answer) {
        return std::abs(shortWay_rad(answer.values[evidence::kAngle], touch.angle_rad)) <= half_rad;
      });
    return told;
  }

  struct Outcome {
    int named = 0;
    int wrong = 0;   ///< another gauge was named
    int silent = 0;  ///< touches told in a wrong place, unflagged
  };

  /// A gauge that failed, and so many touches that it should feel: by a third of what all gauges read
  /// together.
  Outcome feel(Kind kind, int count, int trials, const Rhythm& rhythm = {}) {
    Outcome outcome;
    std::uint64_t number = 0;
    const auto untouched = ring.codes(Eigen::VectorXd::Zero(config.gauges.count), 0);
    for (int trial = 0; trial < trials; ++trial) {
      const auto finger = this->finger(trial);
      const Eigen::VectorXd before = ring.exact(touches.at(number++));
      const double held_strain = kind == Kind::kStuck ? before[kFaulty] : 0;
      const auto fails =
          fault(kind, kind == Kind::kStuck ? ring.codes(before, 0)[kFaulty] : untouched[kFaulty]);
      finger->rest(kRest);
      if (kind == Kind::kStuck) finger->hold(before, kTouch);
      for (int touch = 0; touch < count;) {
        const simulation::Touch next = touches.at(number++);
        const Eigen::VectorXd strains = ring.exact(next);
        if (std::abs(strains[kFaulty] - held_strain) < strains.norm() / 3) continue;
        ++touch;
        if (kind != Kind::kStuck) finger->rest(rhythm.rest, fails);
        finger->hold(strains, rhythm.touch, fails);
        const Told said = told(*finger, {&next, 1});
        outcome.silent += !said.right && !said.flagged;
      }
      outcome.named += finger->observation().outOfUse == kFaultySet;
      outcome.wrong += (finger->observation().outOfUse & ~kFaultySet) != 0;
    }
    std::printf("\n%s: named by %d touches in %d of %d trials, %d wrong, silent wrong places %d ",
                kKindNames[static_cast<std::size_t>(kind)], count, outcome.named, trials, outcome.wrong,
                outcome.silent);
    return outcome;
  }

  /// Touches of these widths and from 2 to 40 N/m, twenty one after the other on a finger.
  void checkNotBlamed(const evidence::Range& width_m, int count) {
    const evidence::TouchDraws draws{config.gauges, {.load_n_per_m = {2, 40}, .width_m = width_m}, 403};
    std::unique_ptr<SampledFinger> finger;
    int blamed = 0, silent = 0, missed = 0;
    for (int i = 0; i < count; ++i) {
      if (i % 20 == 0) finger = this->finger(i);
      const simulation::Touch touch = draws.at(static_cast<std::uint64_t>(i));
      finger->rest(kRest);
      finger->hold(ring.exact(touch), kTouch / 10);
      blamed += finger->observation().outOfUse != 0;
      const Told said = told(*finger, {&touch, 1});
      const bool isTold = finger->observation().touched;
      silent += !said.right && !said.flagged && isTold;
      missed += !isTold;
    }
    std::printf("\n%g to %g mm: a gauge blamed in %d of %d, silent wrong places %d, missed %d ",
                width_m.least * 1e3, width_m.most * 1e3, blamed, count, silent, missed);
    CHECK_COMPARE(blamed, <=, allowedCount(5e-4, count));
    CHECK_COMPARE(silent, <=, allowedCount(2e-4, count));
    LONGS_EQUAL(0, missed);
  }

  /// Two contacts half a pitch to eight apart, 1:1 to 1:4, that come within so many sample sets: together, or
  /// the second to the first.
  void checkPairsNotBlamed(int rise, bool isSecondLater, int count) {
    const evidence::TouchRanges ranges{.load_n_per_m = {10, 40}, .width_m = {0, 3e-3}};
    const evidence::TouchDraws first{config.gauges, ranges, 404}, second{config.gauges, ranges, 405};
    const simulation::Noise draws(406);
    int blamed = 0, silent = 0, located = 0;
    for (int i = 0; i < count; ++i) {
      const auto number = static_cast<std::uint64_t>(i);
      const double apart_pitch = 0.5 + 7.5 * (0.5 + evidence::uniform(draws, number, 0));
      std::array pair{first.at(number), second.at(number)};
      pair[1].angle_rad = pair[0].angle_rad + apart_pitch * 2 * std::numbers::pi / config.gauges.count;
      const Eigen::VectorXd one = ring.exact(pair[0]), other = ring.exact(pair[1]);
      const auto finger = this->finger(i);
      finger->rest(kRest);
      if (isSecondLater) finger->hold(one, kTouch / 10);
      for (int set = 0; set < rise; ++set) {
        const double part = static_cast<double>(set) / rise;
        finger->hold((isSecondLater ? 1 : part) * one + part * other, 1);
      }
      finger->hold(one + other, kTouch);
      blamed += finger->observation().outOfUse != 0;
      const Told said = told(*finger, pair);
      located += said.right;
      silent += !said.right && !said.flagged;
    }
    std::printf("\n%s within %d ms: a gauge blamed in %d of %d, located %d, silent wrong places %d ",
                isSecondLater ? "second joins" : "two", rise, blamed, count, located, silent);
    CHECK_COMPARE(blamed, <=, allowedCount(2e-3, count));
    CHECK_COMPARE(silent, <=, allowedCount(1e-3, count));
    CHECK_COMPARE(located, >=, count * 9 / 10);
  }
};

TEST(GaugeFault, AnOpenOrShortedGaugeIsNamedAtOnce) {
  for (const Kind kind : {Kind::kOpen, Kind::kShort}) {
    const auto finger = this->finger(0);
    finger->rest(kRest);
    LONGS_EQUAL(0, finger->observation().outOfUse);
    finger->rest(2, fault(kind, 0));
    LONGS_EQUAL(kFaultySet, finger->observation().outOfUse);
    CHECK_FALSE(finger->observation().touched);
  }
}

TEST(GaugeFault, AnOpenGaugeIsNoTouchAndTouchesAreToldBesideIt) {
  const auto finger = this->finger(0);
  const simulation::Touch touch{.angle_rad = 2.5, .normal_n_per_m = 20, .width_m = 1e-3};
  for (int i = 0; i < 3; ++i) {
    CHECK_FALSE(finger->rest(kRest, fault(Kind::kOpen, 0)).touched);
    CHECK_TRUE(finger->hold(ring.exact(touch), kTouch, fault(Kind::kOpen, 0)).touched);
    CHECK_TRUE(told(*finger, {&touch, 1}).right);
  }
}

TEST(GaugeFault, AGaugeThatOpensUnderATouchIsNamedWhenItEndsAtTheLatest) {
  const int trials = touchCount(100);
  int named = 0, wrong = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto finger = this->finger(trial);
    const Eigen::VectorXd strains = ring.exact(touches.at(static_cast<std::uint64_t>(trial)));
    finger->rest(kRest);
    finger->hold(strains, kTouch / 10);
    finger->hold(strains, kTouch, fault(Kind::kOpen, 0));
    const GaugeSet out = finger->rest(2, fault(Kind::kOpen, 0)).outOfUse;
    named += out == kFaultySet;
    wrong += (out & ~kFaultySet) != 0;
  }
  std::printf("\nopens under a touch: named in %d of %d ", named, trials);
  CHECK_COMPARE(named, >=, 0.99 * trials);
  LONGS_EQUAL(0, wrong);
}

// Ten times the noise of the others: 65 codes. Touches are within two pitches of it.
TEST(GaugeFault, ANoisyGaugeIsNamedBeforeAnythingTouchesAndTouchesAreToldWithoutIt) {
  constexpr double kNoise_codes = 65, kNear_pitch = 2;
  const double pitch_rad = 2 * std::numbers::pi / config.gauges.count;
  const simulation::Noise draws(407);
  std::uint64_t set = 0;
  const auto noisy = [&](SampledFinger::Codes& codes) {
    const double code = codes[kFaulty] + kNoise_codes * draws.at(set++, 0);
    codes[kFaulty] = static_cast<std::uint16_t>(std::clamp(std::lround(code), 1L, 65'000L));
  };
  const int trials = touchCount(300);
  int named = 0, wrong = 0, silent = 0, flagged = 0, missed = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto finger = this->finger(trial);
    const GaugeSet out = finger->rest(kSetsPerSecond, noisy).outOfUse;
    named += out == kFaultySet;
    wrong += (out & ~kFaultySet) != 0;
    CHECK_TRUE(finger->observation().noisy);
    simulation::Touch touch = touches.at(static_cast<std::uint64_t>(trial));
    touch.angle_rad =
        config.gauges.angle_rad(kFaulty) +
        2 * kNear_pitch * pitch_rad * evidence::uniform(draws, static_cast<std::uint64_t>(trial), 2);
    finger->hold(ring.exact(touch), kTouch, noisy);
    const Told said = told(*finger, {&touch, 1});
    silent += !said.right && !said.flagged;
    flagged += said.flagged;
    missed += !finger->observation().touched;
  }
  std::printf(
      "\nnoisy: named in %d of %d trials, %d wrong; of touches near by %d flagged, %d missed, silent wrong "
      "places %d ",
      named, trials, wrong, flagged, missed, silent);
  CHECK_COMPARE(named, >=, 0.99 * trials - 3 * std::sqrt(0.01 * trials));
  LONGS_EQUAL(0, wrong);
  LONGS_EQUAL(0, missed);
  CHECK_COMPARE(silent, <=, allowedCount(2e-4, trials));
  CHECK_COMPARE(flagged, <=, allowedCount(0.05, trials));
}

TEST(GaugeFault, TheNoisierAGaugeIsTheSoonerItIsNamed) {
  constexpr double kOthers_codes = 6.5;
  const simulation::Noise draws(408);
  std::uint64_t number = 0;
  const int trials = touchCount(20);
  const auto setsUntilNamed = [&](int trial, double times, int most) {
    const auto finger = this->finger(trial);
    for (int set = 0; set < most; ++set) {
      const auto& seen = finger->rest(1, [&](SampledFinger::Codes& codes) {
        const double code = codes[kFaulty] + times * kOthers_codes * draws.at(number++, 0);
        codes[kFaulty] = static_cast<std::uint16_t>(std::clamp(std::lround(code), 1L, 65'000L));
      });
      CHECK_EQUAL(0, seen.outOfUse & ~kFaultySet);
      if (seen.outOfUse != 0) return set;
    }
    return most;
  };
  const int most = 60 * kSetsPerSecond;
  for (const double times : {4.0, 5.0, 10.0, 100.0}) {
    double sum = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const int sets = setsUntilNamed(trial, times, most);
      CHECK_COMPARE(sets, <, most);
      sum += sets;
    }
    std::printf("\n%g times the others' noise: named after %.2f s in the mean ", times,
                sum / trials / kSetsPerSecond);
  }
  for (int trial = 0; trial < trials; ++trial)
    LONGS_EQUAL(10 * kSetsPerSecond, setsUntilNamed(trial, 2, 10 * kSetsPerSecond));
}

// Contacts about as light as the gate lets through, so that most of their sets count as untouched: what they
// do to the gauge below looks most like noise of its own. Zeros that follow drift, or two contacts at once,
// take half of a trembling load for zero, so that the gauge swings to both sides.
TEST(GaugeFault, NoLightContactThatTremblesMakesAHealthyGaugeNoisy) {
  const simulation::Noise draws(409);
  const int trials = touchCount(120), sets = 10 * kSetsPerSecond;
  const double pitch_rad = 2 * std::numbers::pi / config.gauges.count;
  int wrong = 0, byTouches = 0, untouched_sets = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const auto even = [&](std::uint32_t what) {  // in 0 .. 1
      return 0.5 + evidence::uniform(draws, static_cast<std::uint64_t>(trial), 2 * what);
    };
    const auto lightly = [&](std::uint32_t what, double angle_rad) {
      simulation::Touch touch = touches.at(static_cast<std::uint64_t>(2 * trial) + what);
      const double normal = 0.05 + 0.2 * even(what);
      touch.angle_rad = angle_rad;
      touch.tangential_n_per_m *= normal / touch.normal_n_per_m;
      touch.normal_n_per_m = normal;
      return ring.exact(touch);
    };
    const bool areTwo = trial % 3 == 0, drift = trial % 3 == 1;
    const double at_rad = config.gauges.angle_rad(kFaulty) + 0.3 * (even(2) - 0.5) * pitch_rad;
    const Eigen::VectorXd one = lightly(0, at_rad),
                          two = (areTwo ? 1 : 0) * lightly(1, at_rad + 5 * pitch_rad);
    Eigen::VectorXd drift_per_set = Eigen::VectorXd::Zero(config.gauges.count);
    if (drift)
      for (Eigen::Index i = 0; i < drift_per_set.size(); ++i)
        drift_per_set[i] = 1e-6 / kSetsPerSecond *
                           draws.at(static_cast<std::uint64_t>(trial), 100 + static_cast<std::uint32_t>(i));
    const auto finger = this->finger(trial);
    const double share = trial % 2 == 0 ? 1 : 0.5;
    const auto swing = [&](std::uint32_t what, int set) {
      const double hertz = 5 * std::pow(20, even(3 + what));
      return 1 + share * std::sin(2 * std::numbers::pi * hertz * set / kSetsPerSecond);
    };
    for (int set = 0; set < sets; ++set) {
      const auto& seen = finger->hold(swing(0, set) * one + swing(1, set) * two + set * drift_per_set, 1);
      untouched_sets += !seen.touched;
      if (seen.outOfUse == 0) continue;
      ++(seen.touched ? byTouches : wrong);
      break;
    }
  }
  std::printf("\nlight contacts: %d of %d make a gauge noisy, touches convict one in %d; %d s untouched ",
              wrong, trials, byTouches, untouched_sets / kSetsPerSecond);
  LONGS_EQUAL(0, wrong);
}

// A zero that stood still while its gauge was noisy would be a touch when it counts again.
TEST(GaugeFault, ANoisyGaugeThatDriftsIsNoTouchOnceItIsCalm) {
  constexpr double kNoise_codes = 65;
  const simulation::Noise draws(410);
  const auto finger = this->finger(1);
  Eigen::VectorXd strains = Eigen::VectorXd::Zero(config.gauges.count);
  constexpr int kSeconds = 60;
  constexpr double kDrift_strain_per_s = 2e-6;
  std::uint64_t set = 0;
  for (int second = 0; second < kSeconds; ++second)
    for (int i = 0; i < kSetsPerSecond; ++i, ++set) {
      strains[kFaulty] = kDrift_strain_per_s * static_cast<double>(set) / kSetsPerSecond;
      finger->hold(strains, 1, [&](SampledFinger::Codes& codes) {
        codes[kFaulty] =
            static_cast<std::uint16_t>(std::lround(codes[kFaulty] + kNoise_codes * draws.at(set, 0)));
      });
    }
  LONGS_EQUAL(kFaultySet, finger->observation().outOfUse);
  for (int i = 0; i < 2 * kSetsPerSecond; ++i) CHECK_FALSE(finger->hold(strains, 1).touched);
  LONGS_EQUAL(0, finger->observation().outOfUse);
}

// A gauge that reads nothing, or still what an earlier touch left it at, explains alone what is wrong at
// several places: one place could be a second contact as well.
TEST(GaugeFault, ADeadGaugeIsNamedAfterSeveralTouchesThatItShouldFeel) {
  const int trials = touchCount(200);
  const Outcome outcome = feel(Kind::kDead, 8, trials);
  CHECK_COMPARE(outcome.named, >=, 0.95 * trials - 3 * std::sqrt(0.05 * trials));
  CHECK_COMPARE(outcome.wrong, <=, allowedCount(0.002, trials));
  CHECK_COMPARE(outcome.silent, <=, allowedCount(2e-4, 8 * trials));
}

// Touches that end before the search for other answers does, which goes on with what they read.
TEST(GaugeFault, TapsNameADeadGaugeToo) {
  const Outcome outcome = feel(Kind::kDead, 9, touchCount(300), {.touch = 60, .rest = 600});
  CHECK_COMPARE(outcome.named, >=, 0.9 * touchCount(300));
  LONGS_EQUAL(0, outcome.wrong);
}

TEST(GaugeFault, AStuckGaugeIsNamedAfterSeveralTouchesThatItShouldFeel) {
  const int trials = touchCount(200);
  const Outcome outcome = feel(Kind::kStuck, 8, trials);
  CHECK_COMPARE(outcome.named, >=, 0.95 * trials - 3 * std::sqrt(0.05 * trials));
  CHECK_COMPARE(outcome.wrong, <=, allowedCount(0.002, trials));
  CHECK_COMPARE(outcome.silent, <=, allowedCount(2e-4, 8 * trials));
}

TEST(GaugeFault, ADeadGaugeDoesNotComeBack) {
  const auto finger = this->finger(0);
  const auto dead = fault(Kind::kDead, 0x8000);
  for (int round = 0; round < 2; ++round)
    for (double angle_rad = 0; angle_rad < 2 * std::numbers::pi; angle_rad += 0.05) {
      finger->rest(kRest, dead);
      const simulation::Touch touch{.angle_rad = angle_rad, .normal_n_per_m = 20, .width_m = 1e-3};
      finger->hold(ring.exact(touch), kTouch, dead);
      if (round > 0) LONGS_EQUAL(kFaultySet, finger->observation().outOfUse);
    }
}

TEST(GaugeFault, NoWidthIsBlamedOnAGauge) {
  checkNotBlamed({0, 1e-3}, touchCount(1000));
  checkNotBlamed({1e-3, 6e-3}, touchCount(3000));
}

TEST(GaugeFault, TwoContactsAtOnceAreNotBlamedOnAGauge) {
  for (const int rise : {0, 20, 100, 500}) checkPairsNotBlamed(rise, false, touchCount(100));
}

TEST(GaugeFault, ASecondContactThatJoinsIsNotBlamedOnAGauge) {
  for (const int rise : {0, 20, 100, 500}) checkPairsNotBlamed(rise, true, touchCount(100));
}

TEST(GaugeFault, BeyondItsRangeTheFingerGoesOnWithTheOtherGauges) {
  const evidence::TouchDraws heavy{config.gauges, {.load_n_per_m = {130, 130}, .width_m = {1e-3, 1e-3}}, 407};
  const int trials = touchCount(200);
  int saturated = 0, silent = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const simulation::Touch touch = heavy.at(static_cast<std::uint64_t>(trial));
    const auto finger = this->finger(trial);
    finger->rest(kRest);
    const firmware::Observation& seen = finger->hold(ring.exact(touch), kTouch / 10);
    LONGS_EQUAL(seen.saturated, seen.saturated & seen.leftOut);
    LONGS_EQUAL(0, seen.outOfUse);
    saturated += seen.saturated != 0;
    const Told said = told(*finger, {&touch, 1});
    silent += !said.right && !said.flagged;
  }
  std::printf("\n130 N/m: %d of %d saturate a gauge, silent wrong places %d ", saturated, trials, silent);
  CHECK_COMPARE(saturated, >, trials / 4);
  LONGS_EQUAL(0, silent);
}
