// Fingers as they are built: gauges glued by hand, a core and a rubber that are not the drawing's. Nobody
// calibrated them, and model_error is the default.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "host/base/angles.hpp"
#include "host/evidence/fit_model.hpp"
#include "host/evidence/touches.hpp"
#include "host/evidence/uniform.hpp"
#include "tests/closed_loop/sampled_finger.hpp"
#include "tests/closed_loop/stateless_locator.hpp"
#include "tests/closed_loop/touch_count.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr int kFingers = 40;
constexpr int kRestSets = 30;
constexpr int kTouchSets = 100;  ///< sample sets

/// Gauges off by these standard deviations, a core up to 0.1 mm thicker or thinner, a Poisson ratio from 0.49
/// on.
config::FingerConfig builtBy(int seed) {
  const simulation::Noise draws(static_cast<std::uint64_t>(seed));
  config::FingerConfig config;
  config.as_built = {.seed = seed,
                     .angle_deg = 0.5,
                     .depth_m = 0.05e-3,
                     .gain = 0.03,
                     .core_radius_m = 0.2e-3 * evidence::uniform(draws, 0, 0),
                     .poisson_ratio = 0.01 * (evidence::uniform(draws, 0, 2) - 0.5)};
  return config;
}

struct Outcome {
  int touches = 0;
  int told = 0;
  int beyond = 0;  ///< off by more than six of their sigmas, and not flagged
  int silent = 0;  ///< more than half a pitch off, and not flagged
  int wide = 0;    ///< with a width off by more than six of its sigmas, and not flagged
  int flagged = 0;
  int blamed = 0;   ///< touches with a gauge out of use
  int several = 0;  ///< taken for two
};

}  // namespace

TEST_GROUP(AsBuilt) {
  const std::unique_ptr<TableImage> tables =
      std::make_unique<TableImage>(tables::buildTableImage(config::FingerConfig{}));
  const evidence::FitModel model{config::FingerConfig{}};

  /// Touches of one finger, one after the other.
  void touch(int seed, const evidence::TouchRanges& ranges, int count, Outcome& outcome) {
    const config::FingerConfig config = builtBy(seed);
    const evidence::TouchedRing ring(config, static_cast<std::uint64_t>(seed));
    const evidence::TouchDraws draws(config.gauges, ranges, static_cast<std::uint64_t>(seed));
    SampledFinger finger(*tables, ring);
    for (int i = 0; i < count; ++i) {
      const simulation::Touch touch = draws.at(static_cast<std::uint64_t>(i));
      finger.rest(kRestSets);
      finger.hold(ring.exact(touch), kTouchSets);
      ++outcome.touches;
      outcome.blamed += finger.observation().outOfUse != 0;
      outcome.several += finger.observation().several;
      const auto answers = finger.answers();
      if (answers.empty()) continue;
      ++outcome.told;
      const evidence::Answer& answer = answers.front();
      const evidence::Parameters truth{touch.angle_rad, touch.normal_n_per_m, touch.tangential_n_per_m,
                                       model.uniformWidth_m(model.describe(touch).load.moment_rad2)};
      evidence::Parameters error = answer.values - truth;
      error[evidence::kAngle] = shortWay_rad(answer.values[evidence::kAngle], touch.angle_rad);
      const auto isBeyond = (error.array() / answer.sigmas.array()).abs() > 6;
      const bool isFar = isBeyond.head<3>().any();
      outcome.flagged += answer.isFlagged;
      outcome.beyond += isFar && !answer.isFlagged;
      outcome.wide += isBeyond[kWidth] && !answer.isFlagged;
      outcome.silent += !answer.isFlagged && std::abs(error[evidence::kAngle]) > std::numbers::pi / 16;
    }
  }

  Outcome run(const evidence::TouchRanges& ranges, int count) {
    Outcome outcome;
    for (int seed = 1; seed <= kFingers; ++seed) touch(seed, ranges, count / kFingers, outcome);
    std::printf(
        "\n%d touches of %g to %g N/m, %g to %g mm, on %d fingers: told %d, beyond six sigma %d, in width "
        "%d, silent %d, flagged %d, blamed %d, several %d ",
        outcome.touches, ranges.load_n_per_m.least, ranges.load_n_per_m.most, ranges.width_m.least * 1e3,
        ranges.width_m.most * 1e3, kFingers, outcome.told, outcome.beyond, outcome.wide, outcome.silent,
        outcome.flagged, outcome.blamed, outcome.several);
    return outcome;
  }

  static constexpr double kSilent = 2e-4, kFlagged = 0.05;

  static void check(const Outcome& outcome) {
    CHECK_COMPARE(outcome.beyond, <=, allowedCount(0.01, outcome.touches));
    CHECK_COMPARE(outcome.wide, <=, allowedCount(0.01, outcome.touches));
    CHECK_COMPARE(outcome.silent, <=, allowedCount(kSilent, outcome.touches));
    const int untold = outcome.touches - outcome.told;
    CHECK_COMPARE(outcome.flagged + untold, <=, allowedCount(kFlagged, outcome.touches));
    LONGS_EQUAL(0, outcome.blamed);
  }
};

TEST(AsBuilt, LinesAreToldWithTrueSigmas) { check(run({.load_n_per_m = {2, 40}}, touchCount(2000))); }

TEST(AsBuilt, NarrowTouchesAreToldWithTrueSigmas) {
  check(run({.load_n_per_m = {2, 40}, .width_m = {0, 3e-3}}, touchCount(2000)));
}

TEST(AsBuilt, WideTouchesAreToldWithTrueSigmas) {
  check(run({.load_n_per_m = {2, 40}, .width_m = {3e-3, 6e-3}}, touchCount(2000)));
}

// Of two answers the tables' widest may be the worse one by no more than chance.
TEST(AsBuilt, MostTouchesWiderThanTheTablesAreFlagged) {
  const config::FingerConfig config;
  const evidence::TouchedRing ring(config, 1);
  const evidence::TouchDraws draws(
      config.gauges, {.load_n_per_m = {5, 30}, .width_m = {9e-3, 11e-3}, .profile = model::Profile::kUniform},
      1);
  StatelessLocator locator(config);
  const int touches = touchCount(1000);
  int told = 0, flagged = 0, beyond = 0;
  for (int i = 0; i < touches; ++i) {
    const simulation::Touch touch = draws.at(static_cast<std::uint64_t>(i));
    const auto found = locator.locate(ring.exact(touch));
    if (found.contacts.empty()) continue;
    ++told;
    const evidence::Answer& answer = found.contacts.front();
    flagged += answer.isFlagged;
    beyond += !answer.isFlagged && std::abs(shortWay_rad(answer.values[evidence::kAngle], touch.angle_rad)) >
                                       6 * answer.sigmas[evidence::kAngle];
  }
  std::printf("\n%d touches: %d flagged, %d beyond six sigma ", touches, flagged, beyond);
  CHECK_COMPARE(told, >, 0.99 * touches);
  CHECK_COMPARE(flagged, >, 0.88 * touches);
  CHECK_COMPARE(beyond, <=, allowedCount(0.07, touches));
}

// A ring 0.2 mm above its core: one that is 0.1 mm thicker takes a third of the strain away.
TEST(AsBuilt, LoadsReadNearTheCoreAreAsFarOffAsTheySay) {
  constexpr int kPlaces = 64;
  config::FingerConfig config;
  config.finger.core_radius_m = 0.010;
  config.finger.outer_radius_m = 0.015;
  config.gauges.radius_m = 0.0102;
  config.as_built.core_radius_m = 1e-4;
  const evidence::TouchedRing ring(config, 1);
  StatelessLocator locator(config);
  double squares = 0;
  int told = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const simulation::Touch touch{.angle_rad = 2 * std::numbers::pi * i / kPlaces, .normal_n_per_m = 30};
    const auto found = locator.locate(ring.exact(touch));
    if (found.contacts.empty() || found.contacts.front().isFlagged) continue;
    const evidence::Answer& answer = found.contacts.front();
    const double error = answer.values[evidence::kNormal] - touch.normal_n_per_m;
    squares += std::pow(error / answer.sigmas[evidence::kNormal], 2);
    ++told;
  }
  std::printf("\n%d of %d told, RMS of load errors over sigmas %.2f ", told, kPlaces,
              std::sqrt(squares / told));
  CHECK_COMPARE(told, >=, kPlaces * 3 / 4);
  CHECK_COMPARE(squares, <, 2 * 2 * told);
  CHECK_COMPARE(squares, >, 0.5 * 0.5 * told);
}

// A depth that is 0.05 mm off makes a fifth of what they read.
TEST(AsBuilt, PlacesReadNearTheCoreAreSeldomWrongWithoutAFlag) {
  config::FingerConfig config;
  config.finger.core_radius_m = 0.007;
  config.finger.outer_radius_m = 0.010;
  config.gauges.count = 12;
  config.gauges.radius_m = 0.0072;
  const auto image = std::make_unique<TableImage>(tables::buildTableImage(config));
  int touches = 0, told = 0, silent = 0, beyond = 0, flagged = 0;
  for (int seed = 1; seed <= kFingers; ++seed) {
    config.as_built = {.seed = seed, .angle_deg = 0.5, .depth_m = 0.05e-3, .gain = 0.03};
    const evidence::TouchedRing ring(config, static_cast<std::uint64_t>(seed));
    const evidence::TouchDraws draws(config.gauges, {.load_n_per_m = {8, 25}, .width_m = {0, 3e-3}},
                                     static_cast<std::uint64_t>(seed));
    SampledFinger finger(*image, ring);
    for (int i = 0; i < touchCount(2000) / kFingers; ++i, ++touches) {
      const simulation::Touch touch = draws.at(static_cast<std::uint64_t>(i));
      finger.rest(kRestSets);
      finger.hold(ring.exact(touch), kTouchSets);
      const auto answers = finger.answers();
      if (answers.empty()) continue;
      ++told;
      const evidence::Answer& answer = answers.front();
      const double off_rad = shortWay_rad(answer.values[evidence::kAngle], touch.angle_rad);
      flagged += answer.isFlagged;
      beyond += !answer.isFlagged && std::abs(off_rad) > 6 * answer.sigmas[evidence::kAngle];
      silent += !answer.isFlagged && std::abs(off_rad) > std::numbers::pi / 12;
    }
  }
  std::printf("\n%d touches: %d flagged, %d beyond six sigma, %d silent ", touches, flagged, beyond, silent);
  CHECK_COMPARE(told, >, 0.99 * touches);
  CHECK_COMPARE(beyond, <=, allowedCount(3e-3, touches));
  CHECK_COMPARE(silent, <=, allowedCount(3e-3, touches));
  CHECK_COMPARE(flagged, <, touches / 3);
}
