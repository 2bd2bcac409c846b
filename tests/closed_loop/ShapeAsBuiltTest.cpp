// What `shape` says of fingers as they are built, without and with a calibration. Prints the figures of
// host/shape/accuracy.md.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "host/base/angles.hpp"
#include "host/bench/fingers.hpp"
#include "host/calibration/calibrate.hpp"
#include "host/evidence/touched_ring.hpp"
#include "host/evidence/touches.hpp"
#include "host/shape/shape.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr int kShapedFingers = 5;
constexpr std::uint64_t kShapedTouches = 40;  ///< of a finger

/// Of a finger's readings of touches that were measured.
config::FingerConfig calibratedAt(const config::FingerConfig& config, std::uint64_t seed) {
  constexpr std::uint64_t kRows = 400;
  const evidence::TouchedRing ring(config, seed);
  const evidence::TouchDraws draws(config.gauges, {.load_n_per_m = {5, 30}, .width_m = {0.5e-3, 3e-3}}, seed);
  Eigen::MatrixXd rows(kRows, config.gauges.count);
  std::vector<calibration::KnownTouch> known;
  for (std::uint64_t i = 0; i < kRows; ++i) {
    const simulation::Touch touch = draws.at(i);
    rows.row(static_cast<Eigen::Index>(i)) = ring.noisy(ring.exact(touch), i);
    known.push_back({touch.angle_rad / kRadPerDeg, touch.normal_n_per_m, touch.tangential_n_per_m});
  }
  return calibration::calibrate(config, known, rows, {.load = 1e-3, .angle_deg = 0.01}).applied();
}

struct ShapeSurvey {
  std::vector<double> angles_deg, loads, inSigmas;  ///< errors; of the normal load relative to it
  int warned = 0, misfits = 0;

  static double median(std::vector<double> errors) {
    std::ranges::nth_element(errors, errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2));
    return errors[errors.size() / 2];
  }
  /// Of angles and normal loads.
  double beyond(double sigmas) const {
    return static_cast<double>(std::ranges::count_if(inSigmas, [&](double each) { return each > sigmas; })) /
           static_cast<double>(inSigmas.size());
  }
};

/// Touches of the finger that `built` simulates, as an estimator that knows `known` tells them.
void addFinger(const config::FingerConfig& built, const config::FingerConfig& known, std::uint64_t seed,
               ShapeSurvey& survey) {
  const shape::ShapeEstimator estimator(known);
  const evidence::TouchedRing ring(built, seed);
  const evidence::TouchDraws draws(
      built.gauges, {.load_n_per_m = {5, 30}, .lean_deg = {-25, 25}, .width_m = {0.5e-3, 3e-3}}, ~seed);
  Eigen::VectorXd gains(known.gauges.count);
  for (int i = 0; i < known.gauges.count; ++i) gains[i] = known.calibrated(i).gain;
  for (std::uint64_t i = 0; i < kShapedTouches; ++i) {
    const simulation::Touch touch = draws.at(i);
    const auto shape = estimator.estimate(ring.noisy(ring.exact(touch), i).cwiseQuotient(gains));
    CHECK_TRUE(shape.has_value());
    survey.misfits += shape->fitProbability < shape::kUnlikely;
    survey.warned += shape->rivalAngle_rad.has_value();
    const double off_rad =
        std::abs(std::remainder(shape->angle_rad.value - touch.angle_rad, 2 * std::numbers::pi));
    const double offLoad_n_per_m = std::abs(shape->normal_n_per_m.value - touch.normal_n_per_m);
    survey.angles_deg.push_back(off_rad / kRadPerDeg);
    survey.loads.push_back(offLoad_n_per_m / touch.normal_n_per_m);
    survey.inSigmas.push_back(off_rad / shape->angle_rad.sigma);
    survey.inSigmas.push_back(offLoad_n_per_m / shape->normal_n_per_m.sigma);
  }
}

/// Of some fingers, each told by what known(built, seed) makes of it.
template <typename Known>
ShapeSurvey surveyOf(const char* name, Known known) {
  ShapeSurvey survey;
  for (int seed = 1; seed <= kShapedFingers; ++seed) {
    const config::FingerConfig built = bench::fingerAsBuilt(seed);
    addFinger(built, known(built, static_cast<std::uint64_t>(seed)), static_cast<std::uint64_t>(seed),
              survey);
  }
  std::printf(
      "\n%s, %d touches: misfit %d, ambiguous %d, off by %.2f deg, normal load by %.1f %% (medians), "
      "beyond 2, 3, 6 sigma %.1f %%, %.1f %%, %.1f %% ",
      name, kShapedFingers * static_cast<int>(kShapedTouches), survey.misfits, survey.warned,
      ShapeSurvey::median(survey.angles_deg), 100 * ShapeSurvey::median(survey.loads), 100 * survey.beyond(2),
      100 * survey.beyond(3), 100 * survey.beyond(6));
  return survey;
}

}  // namespace

TEST_GROUP(ShapeAsBuilt) {};

TEST(ShapeAsBuilt, SigmasHoldWhatNobodyCalibrated) {
  const ShapeSurvey survey = surveyOf("not calibrated", [](config::FingerConfig built, std::uint64_t) {
    built.as_built = {};
    return built;
  });
  CHECK_TRUE(survey.misfits <= 2);
  CHECK_TRUE(survey.beyond(3) < 0.04 && survey.beyond(6) <= 0.01);
}

// Without a model error nothing fits: what the others' sigmas are held to is no matter of course.
TEST(ShapeAsBuilt, AFingerTakenForPerfectIsAMisfit) {
  const ShapeSurvey survey = surveyOf("taken for perfect", [](config::FingerConfig built, std::uint64_t) {
    built.as_built = {};
    built.gauges.model_error = 0;
    return built;
  });
  CHECK_TRUE(survey.misfits > 100 && survey.beyond(6) > 0.5);
}

TEST(ShapeAsBuilt, ACalibrationTellsAlmostWhatThePerfectFingerDoes) {
  const ShapeSurvey survey = surveyOf("calibrated", calibratedAt);
  CHECK_TRUE(survey.misfits <= 4);
  CHECK_TRUE(ShapeSurvey::median(survey.angles_deg) < 0.1 && ShapeSurvey::median(survey.loads) < 0.01);
  CHECK_TRUE(survey.beyond(3) < 0.04);
}
