// An untouched ring with mains hum on it, and with gauges that drift each on its own: no touch is told.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

#include "host/base/angles.hpp"
#include "host/evidence/uniform.hpp"
#include "tests/closed_loop/sampled_finger.hpp"
#include "tests/closed_loop/touch_count.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr double kMains_hz = 50;
constexpr int kQuiet = 2 * kSetsPerSecond;  ///< before hum begins, in every other trial
constexpr int kHum = 2 * kSetsPerSecond;

/// Of each gauge of a trial, an amplitude and a phase.
struct Hum {
  Eigen::VectorXd amplitude_strain;
  Eigen::VectorXd phase_rad;

  Eigen::VectorXd at(int set) const {
    const double turned_rad = 2 * std::numbers::pi * kMains_hz * set / kSetsPerSecond;
    return amplitude_strain.array() * (phase_rad.array() + turned_rad).sin();
  }
};

/// Each gauge picks up half of the hum or all of it, within a quarter of a period of the others.
Hum drawHum(double most_strain, int gauges, std::uint64_t seed) {
  const simulation::Noise draws(seed);
  Hum hum{Eigen::VectorXd(gauges), Eigen::VectorXd(gauges)};
  for (int gauge = 0; gauge < gauges; ++gauge) {
    const auto number = static_cast<std::uint64_t>(gauge);
    hum.amplitude_strain[gauge] = most_strain * (0.75 + evidence::uniform(draws, number, 0) / 2);
    hum.phase_rad[gauge] = std::numbers::pi * evidence::uniform(draws, number, 2);
  }
  return hum;
}

}  // namespace

TEST_GROUP(Hum) {
  const config::FingerConfig config;
  const std::unique_ptr<TableImage> tables = std::make_unique<TableImage>(tables::buildTableImage(config));

  struct Outcome {
    int ghosts = 0;  ///< trials in which a touch was told
    int noisy = 0;   ///< trials at whose end the ring was called noisy
  };

  Outcome hum(double most_strain, int trials) {
    Outcome outcome;
    for (int trial = 0; trial < trials; ++trial) {
      const auto seed = static_cast<std::uint64_t>(700 + trial);
      const evidence::TouchedRing ring(config, seed);
      const Hum hum = drawHum(most_strain, config.gauges.count, seed);
      SampledFinger finger(*tables, ring);
      bool isTouched = finger.rest(trial % 2 == 0 ? 0 : kQuiet).touched;
      for (int set = 0; set < kHum; ++set) isTouched |= finger.hold(hum.at(set), 1).touched;
      outcome.ghosts += isTouched;
      outcome.noisy += finger.observation().noisy;
    }
    std::printf("\nhum of %g microstrain: ghosts in %d of %d trials, noisy told in %d ", most_strain * 1e6,
                outcome.ghosts, trials, outcome.noisy);
    return outcome;
  }

  /// Trials with ghosts; each gauge drifts by its own part of this standard deviation, steadily.
  int ghostsOfDrift(double spread_strain, int seconds, int trials) {
    int ghosts = 0;
    for (int trial = 0; trial < trials; ++trial) {
      const auto seed = static_cast<std::uint64_t>(800 + trial);
      const evidence::TouchedRing ring(config, seed);
      const simulation::Noise draws(~seed);
      Eigen::VectorXd drift(config.gauges.count);
      for (int gauge = 0; gauge < config.gauges.count; ++gauge)
        drift[gauge] = spread_strain * draws.at(0, static_cast<std::uint32_t>(gauge));
      SampledFinger finger(*tables, ring);
      bool isTouched = finger.rest(kSetsPerSecond).touched;
      const int sets = seconds * kSetsPerSecond;
      for (int set = 0; set < sets + kQuiet; ++set)
        isTouched |= finger.hold(drift * std::min(1.0, static_cast<double>(set) / sets), 1).touched;
      ghosts += isTouched;
    }
    std::printf("\ndrift of %g microstrain in %d s: ghosts in %d of %d trials ", spread_strain * 1e6, seconds,
                ghosts, trials);
    return ghosts;
  }
};

TEST(Hum, IsNoTouchFromItsFirstSetOnAndIsToldAsNoise) {
  for (const double most_strain : {20e-6, 50e-6, 100e-6, 200e-6, 300e-6}) {
    const int trials = touchCount(100);
    const Outcome outcome = hum(most_strain, trials);
    LONGS_EQUAL(0, outcome.ghosts);
    LONGS_EQUAL(trials, outcome.noisy);
  }
}

TEST(Hum, AQuietRingIsNotCalledNoisy) {
  const Outcome outcome = hum(0, touchCount(100));
  LONGS_EQUAL(0, outcome.ghosts);
  LONGS_EQUAL(0, outcome.noisy);
}

TEST(Hum, WhatGaugesDriftByOnTheirOwnIsNoTouch) { LONGS_EQUAL(0, ghostsOfDrift(20e-6, 10, touchCount(100))); }

TEST(Hum, ATouchBesideHumIsTold) {
  const evidence::TouchedRing ring(config, 901);
  const Hum hum = drawHum(20e-6, config.gauges.count, 901);
  const simulation::Touch touch{.angle_rad = 1.3, .normal_n_per_m = 10, .width_m = 1e-3};
  const Eigen::VectorXd strains = ring.exact(touch);
  SampledFinger finger(*tables, ring);
  for (int set = 0; set < kHum; ++set) finger.hold(hum.at(set), 1);
  for (int set = 0; set < kSetsPerSecond; ++set) finger.hold(strains + hum.at(set), 1);
  CHECK_TRUE(finger.observation().touched);
  CHECK_TRUE(finger.observation().noisy);
  const auto answers = finger.answers();
  LONGS_EQUAL(1, answers.size());
  DOUBLES_EQUAL(0, shortWay_rad(answers[0].values[evidence::kAngle], touch.angle_rad),
                6 * answers[0].sigmas[evidence::kAngle]);
}
