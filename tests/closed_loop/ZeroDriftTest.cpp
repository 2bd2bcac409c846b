// Held touches while the gauges drift, and touches that come slowly, from the converter's codes on. A perfect
// finger, model_error 0.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "tests/closed_loop/sampled_finger.hpp"
#include "tests/under_sanitizers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr int kTenMinutes_s = 600;
/// By which a warmer finger reads more after ten minutes: an eighth of what 5 N/m give a gauge under them.
constexpr double kThermal_strain = 3e-4;

simulation::Touch touchAt(double position_pitch, double normal_n_per_m, double tangential_n_per_m = 0) {
  return {.angle_rad = position_pitch * std::numbers::pi / 8,
          .normal_n_per_m = normal_n_per_m,
          .tangential_n_per_m = tangential_n_per_m,
          .width_m = 1e-3};
}

}  // namespace

TEST_GROUP(ZeroDrift) {
  const config::FingerConfig config = [] {
    config::FingerConfig perfect;
    perfect.gauges.model_error = 0;
    return perfect;
  }();
  const std::unique_ptr<TableImage> tables = std::make_unique<TableImage>(tables::buildTableImage(config));
  const evidence::TouchedRing ring{config, 501};
  std::unique_ptr<SampledFinger> finger;
  Eigen::VectorXd drift_per_s = Eigen::VectorXd::Zero(config.gauges.count);
  double drifted_s = 0;

  void setup() override { renew(); }
  void renew() {
    finger = std::make_unique<SampledFinger>(*tables, ring);
    drifted_s = 0;
    drift_per_s.setZero();
    step(Eigen::VectorXd::Zero(config.gauges.count), kSetsPerSecond);
  }

  void step(const Eigen::VectorXd& strains, int sets = 1) {
    for (int i = 0; i < sets; ++i) {
      finger->hold(strains + drifted_s * drift_per_s, 1);
      drifted_s += 1.0 / kSetsPerSecond;
    }
  }
  void rest(int seconds) { step(Eigen::VectorXd::Zero(config.gauges.count), seconds * kSetsPerSecond); }

  /// What is told in a second.
  struct Second {
    int told = 0;                       ///< of 100 looks
    int flagged = 0;                    ///< of those
    double normal = 0, tangential = 0;  ///< means [N/m]

    /// Looks at which nothing is told do not count as flagged.
    bool isMostlyFlagged() const { return flagged >= 50; }
  };
  /// `strains(share)`: what the touch gives at that share of the second.
  template <typename Strains>
  Second second(Strains strains) {
    constexpr int kEvery = kSetsPerSecond / 100;
    Second result;
    for (int set = 0; set < kSetsPerSecond; ++set) {
      step(strains(static_cast<double>(set) / kSetsPerSecond));
      if (set % kEvery != 0) continue;
      const auto answers = finger->answers();
      if (answers.empty()) continue;
      ++result.told;
      result.flagged += answers[0].isFlagged;
      result.normal += answers[0].values[evidence::kNormal];
      result.tangential += answers[0].values[evidence::kTangential];
    }
    result.normal /= std::max(result.told, 1);
    result.tangential /= std::max(result.told, 1);
    return result;
  }
  Second hold(const Eigen::VectorXd& strains, int seconds) {
    Second last;
    for (int s = 0; s < seconds; ++s)
      last = second([&](double) -> const Eigen::VectorXd& { return strains; });
    return last;
  }

  /// What a touch held for ten minutes gains is at most this part of its load.
  void checkKept(const simulation::Touch& touch, double part) {
    const Eigen::VectorXd strains = ring.exact(touch);
    const Second first = hold(strains, 5), last = hold(strains, kTenMinutes_s);
    std::printf("\nnormal %.3f to %.3f N/m, tangential %.3f to %.3f ", first.normal, last.normal,
                first.tangential, last.tangential);
    LONGS_EQUAL(100, last.told);
    DOUBLES_EQUAL(first.normal, last.normal, part * touch.normal_n_per_m);
    DOUBLES_EQUAL(first.tangential, last.tangential, part * touch.normal_n_per_m);
  }

  struct Growth {
    int silent = 0;  ///< seconds in which it is told wrong without a flag, from where it should be seen on
    Second last;
  };
  Growth grow(const simulation::Touch& touch, int seconds) {
    const Eigen::VectorXd strains = ring.exact(touch);
    const double seen_n_per_m = touch.normal_n_per_m / 5;
    Growth growth;
    for (int s = 0; s < seconds; ++s) {
      const Second now =
          second([&](double share) -> Eigen::VectorXd { return (s + share) / seconds * strains; });
      const double truth = touch.normal_n_per_m * (s + 0.5) / seconds;
      const bool isRight = now.told == 100 && std::abs(now.normal - truth) < 0.02 * touch.normal_n_per_m;
      growth.silent += truth > seen_n_per_m && !isRight && !now.isMostlyFlagged();
      growth.last = now;
    }
    return growth;
  }

  /// A touch that grows steadily is told right, or flagged, from the moment on that it should be seen.
  void checkGrowthTold(const simulation::Touch& touch, int seconds) {
    const Growth growth = grow(touch, seconds);
    std::printf("\ngrown within %d s: %.3f N/m, silent for %d s ", seconds, growth.last.normal,
                growth.silent);
    LONGS_EQUAL(100, growth.last.told);
    DOUBLES_EQUAL(touch.normal_n_per_m, growth.last.normal, 0.02 * touch.normal_n_per_m);
    LONGS_EQUAL(0, growth.silent);
    rest(5);
    CHECK_FALSE(finger->observation().touched);
  }
};

TEST(ZeroDrift, AHeldTouchKeepsItsLoadOverTenMinutesOfWarmth) {
  for (const double position_pitch : {3.0, 7.3, 12.5}) {
    renew();
    drift_per_s.setConstant(kThermal_strain / kTenMinutes_s);
    checkKept(touchAt(position_pitch, 5), 0.02);
    drift_per_s.setZero();
  }
}

TEST(ZeroDrift, AHeldTouchIsNotEatenWithoutDriftEither) {
  for (const double position_pitch : {3.0, 5.4}) {
    renew();
    checkKept(touchAt(position_pitch, 5, 2), 0.01);
    rest(5);
    CHECK_FALSE(finger->observation().touched);
  }
}

// One side warmer than the other is not told from the touch: the finger says that something is wrong.
TEST(ZeroDrift, AnUnevenWarmthIsFlaggedBeforeItMovesTheLoadByAFifth) {
  for (int gauge = 0; gauge < config.gauges.count; ++gauge)
    drift_per_s[gauge] =
        kThermal_strain / 3 / kTenMinutes_s * std::cos(2 * std::numbers::pi * gauge / config.gauges.count);
  const Eigen::VectorXd strains = ring.exact(touchAt(7.3, 5));
  double silent_n_per_m = 0;
  for (int s = 0; s < kTenMinutes_s; ++s) {
    const Second now = hold(strains, 1);
    if (!now.isMostlyFlagged()) silent_n_per_m = std::max(silent_n_per_m, std::abs(now.normal - 5));
  }
  std::printf("\noff by at most %.2f N/m unflagged ", silent_n_per_m);
  CHECK_COMPARE(silent_n_per_m, <=, 0.2 * 5);
}

TEST(ZeroDrift, ATouchOverAGaugeOrAGapThatGrowsOverFiveMinutesIsToldOrFlagged) {
  for (const double position_pitch : {3.0, 7.5}) {
    renew();
    checkGrowthTold(touchAt(position_pitch, 5), 300);
  }
}

TEST(ZeroDrift, ATouchThatGrowsOverFiveMinutesIsToldOrFlaggedWhereverItIs) {
  constexpr int kPlaces = kSanitized ? 2 : 20;
  for (int place = 0; place < kPlaces; ++place) {
    renew();
    const Growth growth = grow(touchAt(3 + 0.157 * place, 5, 2 * std::sin(5 * place)), 300);
    if (growth.silent > 0) std::printf("\nplace %d: silent for %d s ", place, growth.silent);
    LONGS_EQUAL(0, growth.silent);
    DOUBLES_EQUAL(5, growth.last.normal, 0.02 * 5);
  }
}

TEST(ZeroDrift, ATouchThatGrowsOverAMinuteIsTold) { checkGrowthTold(touchAt(5.4, 8, 2), 60); }

TEST(ZeroDrift, UntouchedZerosFollow) {
  for (int gauge = 0; gauge < config.gauges.count; ++gauge)
    drift_per_s[gauge] = kThermal_strain / kTenMinutes_s * (1 + std::cos(2.7 * gauge));
  rest(kTenMinutes_s / 3);
  CHECK_FALSE(finger->observation().touched);
  CHECK_COMPARE(finger->pipeline().zeroTracker().age_sets(), <=, firmware::ZeroTracker::kInterval);
  CHECK_TRUE(finger->pipeline().zeroTracker().lastChange_q32() > 0);
}

TEST(ZeroDrift, TenMinutesOfTouchMakeTheZeroStale) {
  const Eigen::VectorXd strains = ring.exact(touchAt(5.4, 5));
  hold(strains, kTenMinutes_s - 2);
  CHECK_FALSE(finger->observation().staleZero);
  hold(strains, 3);
  CHECK_TRUE(finger->observation().staleZero);
  rest(5);
  CHECK_FALSE(finger->observation().staleZero);
}
