// Touches that slide fast round a calibrated finger of 60 mm, from the converter's codes on: a small signal
// over its noise, and no model error that would cover an answer on the wrong side of a gauge.
#include <cmath>
#include <cstdio>
#include <memory>

#include "host/base/angles.hpp"
#include "host/evidence/touches.hpp"
#include "host/evidence/uniform.hpp"
#include "host/simulation/noise.hpp"
#include "tests/closed_loop/sampled_finger.hpp"
#include "tests/closed_loop/touch_count.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

config::FingerConfig largeFinger() {
  config::FingerConfig config;
  config.finger = {
      .core_radius_m = 22e-3, .outer_radius_m = 30e-3, .length_m = 0.04, .shear_modulus_pa = 5e4};
  config.gauges.count = 20;
  config.gauges.radius_m = 24.4e-3;
  config.gauges.noise_strain = 1e-5;
  config.gauges.full_scale_strain = 0.03;
  config.gauges.model_error = 5e-4;
  return config;
}

}  // namespace

TEST_GROUP(Sliding) {
  static constexpr int kRest = 30, kSettled = 30, kSets = 1500;
  static constexpr double kFastest_deg = 0.24;  ///< a set

  const config::FingerConfig config = largeFinger();
  const std::unique_ptr<TableImage> tables = std::make_unique<TableImage>(tables::buildTableImage(config));
  const evidence::TouchedRing ring{config, 701};
  const evidence::TouchDraws touches{config.gauges, {.load_n_per_m = {4, 25}, .width_m = {5e-4, 3e-3}}, 702};
  const simulation::Noise draws{703};

  struct Frames {
    int told = 0, flagged = 0;
    int beyond = 0;  ///< a place off by more than six of its errors, without a flag
  };

  Frames slide(std::uint64_t number) const {
    SampledFinger finger(*tables, ring, number << 32);
    simulation::Touch touch = touches.at(number);
    const double step_rad = 2 * kFastest_deg * kRadPerDeg * evidence::uniform(draws, number, 0);
    finger.rest(kRest);
    Frames frames;
    for (int set = 0; set < kSets; ++set, touch.angle_rad += step_rad) {
      finger.hold(ring.exact(touch), 1);
      const auto answers = finger.answers();
      if (set < kSettled || answers.empty()) continue;
      ++frames.told;
      const double off_rad = shortWay_rad(answers[0].values[evidence::kAngle], touch.angle_rad);
      if (answers[0].isFlagged)
        ++frames.flagged;
      else if (std::abs(off_rad) > 6 * answers[0].sigmas[evidence::kAngle])
        ++frames.beyond;
    }
    return frames;
  }
};

TEST(Sliding, PlacesBeyondTheirErrorsAreRare) {
  const int count = touchCount(100);
  Frames all;
  int touchesBeyond = 0;
  for (int i = 0; i < count; ++i) {
    const Frames frames = slide(static_cast<std::uint64_t>(i));
    all.told += frames.told;
    all.flagged += frames.flagged;
    all.beyond += frames.beyond;
    touchesBeyond += frames.beyond > 0;
  }
  std::printf(
      "\n%d sliding touches: of %d frames flagged %.2g %%, beyond six errors without a flag %.2g %%, in %d "
      "touches ",
      count, all.told, 100.0 * all.flagged / all.told, 100.0 * all.beyond / all.told, touchesBeyond);
  CHECK_COMPARE(all.beyond, <=, all.told / 20'000);
  CHECK_COMPARE(all.flagged, <=, all.told / 30);
}
