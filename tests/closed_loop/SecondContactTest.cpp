// A second contact that joins a first one, from the converter's codes on: how long it is not told, whether
// what is told until then is flagged, and that the first stays the first. The default finger, model_error
// 0.05.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "host/base/angles.hpp"
#include "host/evidence/touches.hpp"
#include "host/evidence/uniform.hpp"
#include "host/simulation/noise.hpp"
#include "tests/closed_loop/sampled_finger.hpp"
#include "tests/closed_loop/touch_count.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(SecondContact) {
  static constexpr int kRest = 30, kFirstAlone = 300, kLongest = 1000;  ///< sample sets

  const config::FingerConfig config;
  const std::unique_ptr<TableImage> tables = std::make_unique<TableImage>(tables::buildTableImage(config));
  const evidence::TouchedRing ring{config, 601};
  const evidence::TouchDraws touches{config.gauges, {.load_n_per_m = {10, 30}, .width_m = {0, 3e-3}}, 602};
  const simulation::Noise draws{603};

  std::array<simulation::Touch, 2> pair(std::uint64_t number) const {
    std::array<simulation::Touch, 2> pair{touches.at(2 * number), touches.at(2 * number + 1)};
    const double apart_pitch = 4 + 8 * (0.5 + evidence::uniform(draws, number, 0));
    pair[1].angle_rad = pair[0].angle_rad + apart_pitch * 2 * std::numbers::pi / config.gauges.count;
    return pair;
  }

  struct Outcome {
    int sets = 0;       ///< from the first with the second contact to the first that tells two contacts
    int unflagged = 0;  ///< of those
    bool isFirstFirst = false;  ///< the contact that was there before is told as the first
  };

  /// The second contact slides so far in a set.
  Outcome join(std::uint64_t number, double step_rad) const {
    SampledFinger finger(*tables, ring, number << 32);
    auto pair = this->pair(number);
    finger.rest(kRest);
    finger.hold(ring.exact(pair[0]), kFirstAlone);
    Outcome outcome;
    for (; outcome.sets < kLongest; ++outcome.sets) {
      finger.hold(ring.exact(pair), 1);
      const auto answers = finger.answers();
      if (answers.size() == 2) {
        const auto off_rad = [&](std::size_t i) {
          return std::abs(shortWay_rad(answers[i].values[evidence::kAngle], pair[0].angle_rad));
        };
        outcome.isFirstFirst = off_rad(0) < off_rad(1);
        break;
      }
      outcome.unflagged += !answers.empty() && !answers[0].isFlagged;
      pair[1].angle_rad += step_rad;
    }
    return outcome;
  }

  void check(double step_rad, int count, int longest) const {
    std::vector<int> sets;
    int unflagged = 0, exchanged = 0;
    for (int i = 0; i < count; ++i) {
      const Outcome outcome = join(static_cast<std::uint64_t>(i), step_rad);
      sets.push_back(outcome.sets);
      unflagged = std::max(unflagged, outcome.unflagged);
      exchanged += !outcome.isFirstFirst;
    }
    std::ranges::sort(sets);
    std::printf(
        "\na second contact that slides by %g mm a set is told after %d sample sets (median), %d (worst of "
        "%d); before, at most %d are not flagged ",
        step_rad * config.finger.outer_radius_m * 1e3, sets[sets.size() / 2], sets.back(), count, unflagged);
    CHECK_COMPARE(sets.back(), <=, longest);
    LONGS_EQUAL(0, unflagged);
    LONGS_EQUAL(0, exchanged);
  }
};

TEST(SecondContact, ThatJoinsIsToldWithinAThirdOfASecond) { check(0, touchCount(100), 333); }

TEST(SecondContact, ThatJoinsAndSlidesIsToldWithinHalfASecond) {
  check(10e-6 / config.finger.outer_radius_m, touchCount(100), 500);
}
