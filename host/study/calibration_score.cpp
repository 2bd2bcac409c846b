#include "host/study/calibration_score.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "host/calibration/expected_error.hpp"
#include "host/calibration/touch_fit.hpp"
#include "host/evidence/touched_ring.hpp"
#include "host/evidence/touches.hpp"
#include "host/simulation/built_finger.hpp"
#include "host/simulation/noise.hpp"

namespace strainfinger::study {
namespace {

using calibration::Drawing, calibration::RingResponse, calibration::TouchState, calibration::inMetres;

constexpr std::uint64_t kNewTouchSeeds = 3'000'000, kChanceSeeds = 4'000'000;

/// Normal deviates of that covariance, a column a draw.
Eigen::MatrixXd drawnBy(const Eigen::MatrixXd& covariance, const simulation::Noise& draws) {
  Eigen::MatrixXd drawn(covariance.rows(), kChances);
  for (Eigen::Index j = 0; j < drawn.cols(); ++j)
    for (Eigen::Index i = 0; i < drawn.rows(); ++i)
      drawn(i, j) = draws.at(static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(2 * j));
  return covariance.llt().matrixL() * drawn;
}

}  // namespace

Eigen::VectorXd trueDeviations(const config::FingerConfig& finger) {
  const Drawing drawing(finger);
  const simulation::BuiltFinger built = simulation::builtFinger(finger);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(drawing.unknowns());
  for (int i = 0; i < drawing.gauges(); ++i) {
    using namespace calibration;
    const model::PlacedGauge drawn = finger.drawn(i), real = built.gauges[static_cast<std::size_t>(i)];
    truth[Drawing::at(i, kGain)] = (real.gain - drawn.gain) / drawing.tolerance(kGain);
    truth[Drawing::at(i, kAngleOffset)] =
        (real.angle_rad - drawn.angle_rad) / drawing.tolerance(kAngleOffset);
    truth[Drawing::at(i, kDepthOffset)] = (drawn.radius_m - real.radius_m) / drawing.tolerance(kDepthOffset);
  }
  const auto fill = [&](calibration::RubberUnknown unknown, double difference) {
    truth[drawing.at(unknown)] = difference / drawing.tolerance(unknown);
  };
  fill(calibration::kCoreRadius, built.annulus.core_radius_m - finger.finger.core_radius_m);
  fill(calibration::kPoissonRatio, built.annulus.poisson_ratio - finger.finger.poisson_ratio);
  fill(calibration::kShearModulus, std::log(built.annulus.shear_modulus_pa / finger.finger.shear_modulus_pa));
  return truth;
}

Eigen::VectorXd errorsOverSigma(const calibration::CalibrationResult& result,
                                const config::FingerConfig& finger) {
  const Eigen::VectorXd error = result.deviations() - trueDeviations(finger);
  return error.array() / result.covariance().diagonal().array().sqrt();
}

NewTouches newTouches(const calibration::CalibrationResult& result, const config::FingerConfig& finger,
                      int count, std::uint64_t seed) {
  const evidence::TouchedRing touched(finger, kNewTouchSeeds + seed);
  const evidence::TouchDraws draws(finger.gauges, {.width_m = {2e-3, 2e-3}}, kNewTouchSeeds + seed);
  const Drawing& drawing = result.drawing();
  const int last = RingResponse::lastHarmonic(drawing);
  const RingResponse fitted(drawing, result.deviations(), last), truth(drawing, trueDeviations(finger), last);
  const double radius_m = finger.finger.outer_radius_m, noise_strain = finger.gauges.noise_strain;
  const Eigen::MatrixXd drawnFingers = drawnBy(result.covariance(), simulation::Noise(kChanceSeeds + seed));
  const simulation::Noise chance(2 * kChanceSeeds + seed);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  NewTouches sum{zero, zero, Eigen::Matrix3Xd::Zero(3, kChances), zero};
  for (int i = 0; i < count; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const simulation::Touch drawn = draws.at(number);
    const TouchState touch{drawn.angle_rad, drawn.normal_n_per_m, drawn.tangential_n_per_m,
                           momentOf(drawn.profile, *drawn.width_m / radius_m)};
    const Eigen::VectorXd readings = touched.noisy(touched.exact(drawn), number);
    const TouchState found = refineTouch(fitted, {readings, noise_strain, {}}, touch).touch;
    const auto variances = touchVariances(fitted, touch, result.covariance(), noise_strain);
    const auto known = touchVariances(truth, touch, result.covariance(), noise_strain);
    const Eigen::MatrixXd missed =
        calibration::TouchEquations(fitted, touch, noise_strain).pull() * drawnFingers;
    for (Eigen::Index j = 0; j < kChances; ++j) {
      TouchState noise = variances.noise.cwiseSqrt();
      for (Eigen::Index k = 0; k < noise.size(); ++k)
        noise[k] *= chance.at(number, static_cast<std::uint32_t>(2 * (noise.size() * j + k)));
      sum.byChance.col(j) += inMetres(missed.col(j) + noise, radius_m).cwiseAbs2();
    }
    sum.load_n_per_m += touch[calibration::kNormalLoad] * touch[calibration::kNormalLoad];
    sum.error += inMetres(found - touch, radius_m).cwiseAbs2();
    sum.predicted += inMetres(variances.total.cwiseSqrt(), radius_m).cwiseAbs2();
    sum.bound += inMetres(known.noise.cwiseSqrt(), radius_m).cwiseAbs2();
  }
  for (Eigen::Vector3d* each : {&sum.error, &sum.predicted, &sum.bound}) *each = (*each / count).cwiseSqrt();
  sum.load_n_per_m = std::sqrt(sum.load_n_per_m / count);
  sum.byChance = (sum.byChance / count).cwiseSqrt().array().colwise() / sum.predicted.array();
  return sum;
}

}  // namespace strainfinger::study
