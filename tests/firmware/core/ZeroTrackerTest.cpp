#include <algorithm>
#include <cmath>

#include "firmware/core/zero_tracker.hpp"

#include "firmware/core/detect.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(ZeroTracker) {
  const ModelRing ring;
  Calibration calibration = tabledCalibration(ring.tables());
  const Calibration first = calibration;
  ZeroTracker tracker;
  Linearisation scratch{};
  Locator locator{FitMode::kRefined};
  Presses random{16, 1, 601};

  /// What conditioning makes of strains: less what the zero has followed.
  std::vector<std::int32_t> conditionedBy(const std::vector<double>& strains) const {
    auto raw = ring.raw(strains);
    for (std::size_t i = 0; i < raw.size(); ++i)
      raw[i] -= static_cast<std::int32_t>(std::lround(std::ldexp(followed_strain(i), 32)));
    return raw;
  }
  double followed_strain(std::size_t gauge) const {
    const double codes = std::ldexp(calibration.zero_q15[gauge] - first.zero_q15[gauge], -15);
    return codes * std::ldexp(calibration.gain[gauge], 15 - 64);
  }
  void takeUntouched(const std::vector<double>& strains, GaugeSet leftOut = 0, bool isTimeLeft = true) {
    tracker.age();
    tracker.take(ring.tables(), conditionedBy(strains), nullptr, leftOut, calibration, scratch, isTimeLeft);
  }
  void takeTouched(const std::vector<double>& strains) {
    const auto raw = conditionedBy(strains);
    locator.update(ring.tables(), raw, ring.allGauges());
    tracker.age();
    tracker.take(ring.tables(), raw, &locator, 0, calibration, scratch);
  }
  std::vector<double> noisy(const std::vector<double>& strains) {
    return random.noisy(strains, ring.noise_strain());
  }
  /// By 10 microstrain in all. In each hundredth set a gauge far from the touch is off by so much.
  void holdWhileAllDrift(double spike_strain) {
    const auto held = ring.strains({4.3, 20, 3, 1});
    constexpr int kSets = 30 * ZeroTracker::kInterval;
    for (int set = 0; set < kSets; ++set) {
      auto strains = held;
      for (double& strain : strains) strain += 10e-6 * set / kSets;
      if (set % 100 == 50) strains[11] += spike_strain;
      takeTouched(noisy(strains));
    }
  }
  double mostFollowed_strain() const {
    double most = 0;
    for (std::size_t i = 0; i < 16; ++i) most = std::max(most, std::abs(followed_strain(i)));
    return most;
  }
};

TEST(ZeroTracker, FollowsDriftOfTheUntouchedRing) {
  // 10 microstrain a minute, all gauges alike: as when the finger warms up.
  constexpr int kSets = 60 * 1024;
  for (int set = 0; set < kSets; ++set) takeUntouched(noisy(std::vector<double>(16, 10e-6 * set / kSets)));
  for (std::size_t i = 0; i < 16; ++i) DOUBLES_EQUAL(10e-6, followed_strain(i), 4e-6);
}

TEST(ZeroTracker, FollowsEachGaugesOwnDrift) {
  constexpr int kSets = 60 * 1024;
  std::vector<double> drift(16);
  for (std::size_t i = 0; i < 16; ++i) drift[i] = i % 3 == 0 ? 10e-6 : i % 3 == 1 ? -8e-6 : 2e-6;
  for (int set = 0; set < kSets; ++set) {
    std::vector<double> strains = drift;
    for (double& strain : strains) strain *= static_cast<double>(set) / kSets;
    takeUntouched(noisy(strains));
  }
  for (std::size_t i = 0; i < 16; ++i) DOUBLES_EQUAL(drift[i], followed_strain(i), 4e-6);
}

TEST(ZeroTracker, DoesNotFollowATouchThatGrowsOverMinutes) {
  // 5 N/m in 5 minutes, for as long as it is too faint to open the gate.
  ContactGate gate;
  const auto unit = ring.strains({5.3, 1, 0.2, 1});
  for (int set = 0; set < 5 * 60'000; ++set) {
    std::vector<double> strains = unit;
    for (double& strain : strains) strain *= 5.0 * set / 300'000;
    const auto read = noisy(strains);
    if (gate.update(ring.constants(), gateEnergy(ring.constants(), conditionedBy(read)))) break;
    takeUntouched(read);
  }
  CHECK_TRUE(gate.touched());
  CHECK(mostFollowed_strain() < 0.02 * 0.00045 * 5);
}

// At some places the coarse grid's best point leads the fit to another answer, which doesn't explain the
// touch's averages well enough: only a second start finds the touch.
TEST(ZeroTracker, DoesNotFollowFaintTouchesWhoseAveragesLookLikeAnotherTouchAtFirst) {
  constexpr int kPlaces = 50;
  int followed = 0;
  for (const auto& [lean, width_mm] : {std::pair{-0.3, 0.43}, {0.3, 0.43}, {0.0, 0.43}, {0.3, 3.5}})
    for (int place = 0; place < kPlaces; ++place) {
      tracker = {};
      calibration = first;
      const double load = 0.6;
      const auto strains =
          ring.strains({5 + static_cast<double>(place) / kPlaces, load, lean * load, width_mm});
      for (int set = 0; set < ZeroTracker::kUntilFollowed; ++set) takeUntouched(noisy(strains));
      followed += mostFollowed_strain() > 0;
    }
  LONGS_EQUAL(0, followed);
}

TEST(ZeroTracker, FollowsAtMostADeviationAnInterval) {
  const std::vector<double> strains(16, 50e-6);
  for (int set = 0; set < ZeroTracker::kUntilFollowed; ++set) takeUntouched(strains);
  DOUBLES_EQUAL(ring.noise_strain(), followed_strain(3), 0.1e-6);
  DOUBLES_EQUAL(ring.noise_strain(), std::ldexp(*tracker.lastChange_q32(), -32), 0.1e-6);
}

// Clamped one by one, what is left of uneven drift may look like what a contact does.
TEST(ZeroTracker, WhatIsLeftOfUnevenDriftKeepsItsShape) {
  std::vector<double> strains(16, 50e-6);
  for (std::size_t i = 1; i < strains.size(); i += 2) strains[i] = -20e-6;
  for (int set = 0; set < ZeroTracker::kUntilFollowed; ++set) takeUntouched(strains);
  DOUBLES_EQUAL(ring.noise_strain(), followed_strain(2), 0.1e-6);
  for (std::size_t i = 1; i < strains.size(); i += 2)
    DOUBLES_EQUAL(-0.4 * followed_strain(2), followed_strain(i), 0.1e-6);
}

TEST(ZeroTracker, FollowsAsSoonAsThereIsTime) {
  const std::vector<double> strains(16, 50e-6);
  for (int set = 0; set < 2 * ZeroTracker::kInterval; ++set) takeUntouched(strains, 0, false);
  DOUBLES_EQUAL(0, followed_strain(3), 1e-9);
  for (int set = 0; set < 4 * ZeroTracker::kEvery; ++set) takeUntouched(strains);
  DOUBLES_EQUAL(ring.noise_strain(), followed_strain(3), 0.1e-6);
}

TEST(ZeroTracker, LearnsNothingOfGaugesLeftOut) {
  for (int set = 0; set < ZeroTracker::kUntilFollowed; ++set)
    takeUntouched(std::vector<double>(16, 30e-6), set == 7 ? 1u << 4 : 0);
  LONGS_EQUAL(first.zero_q15[4], calibration.zero_q15[4]);
  CHECK(first.zero_q15[5] != calibration.zero_q15[5]);
}

TEST(ZeroTracker, UnderAHeldTouchFollowsWhatAllGaugesDriftByInCommon) {
  holdWhileAllDrift(0);
  for (std::size_t i = 0; i < 16; ++i) DOUBLES_EQUAL(10e-6, followed_strain(i), 2e-6);
}

TEST(ZeroTracker, ASetThatTheAnswerDoesNotExplainIsPassedOver) {
  holdWhileAllDrift(300e-6);
  for (std::size_t i = 0; i < 16; ++i) DOUBLES_EQUAL(10e-6, followed_strain(i), 2e-6);
}

TEST(ZeroTracker, AHeldTouchIsNotTrackedAway) {
  const auto strains = ring.strains({4.3, 20, 3, 1});
  for (int set = 0; set < 60 * ZeroTracker::kInterval; ++set) takeTouched(noisy(strains));
  CHECK(mostFollowed_strain() < 2e-6);
  DOUBLES_EQUAL(20, ring.pressOf(locator.answer().solution.contact[0], locator.answer().shift).normal, 0.2);
}

TEST(ZeroTracker, AHeldTouchOfAFingerThatIsNotAsDrawnLeavesNoGhost) {
  auto strains = ring.strains({4.3, 20, 3, 1.5});
  for (double& strain : strains) strain *= 1 + random.noise(0.03);
  for (int set = 0; set < 60 * ZeroTracker::kInterval; ++set) takeTouched(noisy(strains));
  ContactGate gate;
  for (int set = 0; set < 1000; ++set) {
    const auto raw = conditionedBy(noisy(std::vector<double>(16, 0)));
    CHECK_FALSE(gate.update(ring.constants(), gateEnergy(ring.constants(), raw)));
  }
}

// As pushed by hand, for five seconds at a time: pressed within half a second, and let go within another.
TEST(ZeroTracker, LoadsThatChangeMoveNoZero) {
  const auto unit = ring.strains({4.3, 1, 0.1, 1.5});
  constexpr int kSets = 5000, kRamp = 500;
  for (int press = 0; press < 20; ++press) {
    for (int set = 0; set < kSets; ++set) {
      const double share = std::min({set, kSets - set, kRamp}) / static_cast<double>(kRamp);
      auto strains = unit;
      for (double& strain : strains) strain *= (0.2 + 0.8 * share) * (20 + press);
      takeTouched(noisy(strains));
    }
    locator.release();
    takeUntouched(noisy(std::vector<double>(16, 0)));
  }
  CHECK_COMPARE(mostFollowed_strain(), <, 2e-6);
}

TEST(ZeroTracker, CountsItsAgeWhileItIsTouched) {
  for (int set = 0; set < 2 * ZeroTracker::kInterval; ++set) takeUntouched(noisy(std::vector<double>(16, 0)));
  CHECK(tracker.age_sets() <= ZeroTracker::kInterval);
  const std::uint32_t before = tracker.age_sets();
  for (int set = 0; set < 3000; ++set) takeTouched(noisy(ring.strains({4.3, 20, 3, 1})));
  LONGS_EQUAL(before + 3000, tracker.age_sets());
}

TEST(ZeroTracker, TenMinutesWithoutAnUntouchedRingAreStale) {
  const auto raw = ring.raw(ring.strains({4.3, 20, 3, 1}));
  const auto take = [&] {
    tracker.age();
    tracker.take(ring.tables(), raw, &locator, 0, calibration, scratch);
  };
  for (std::uint32_t set = 0; set < ZeroTracker::kStaleSets; ++set) take();
  CHECK_FALSE(tracker.stale());
  take();
  CHECK_TRUE(tracker.stale());
}
