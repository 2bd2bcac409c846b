#include "host/calibration/expected_error.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/calibration/touch_fit.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::calibration {
namespace {

constexpr double kLoad_n_per_m = 30, kWidth_m = 2e-3;
constexpr int kPlacesPerGauge = 6;

}  // namespace

std::vector<TouchState> judgedTouches(const Drawing& drawing) {
  const double moment_rad2 = model::momentOfWidth(kWidth_m / drawing.config().finger.outer_radius_m);
  const int places = kPlacesPerGauge * drawing.gauges();
  std::vector<TouchState> touches;
  for (int place = 0; place < places; ++place)
    for (const double lean : {-0.5, 0.1, 0.5})
      touches.push_back(
          {2 * std::numbers::pi * place / places, kLoad_n_per_m, lean * kLoad_n_per_m, moment_rad2});
  return touches;
}

Eigen::MatrixXd withoutConventions(const Drawing& drawing, const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd fixed = Eigen::MatrixXd::Zero(drawing.unknowns(), 2);
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) fixed(Drawing::at(gauge, kAngleOffset), 0) = 1;
  fixed(drawing.at(kShearModulus), 1) = 1;
  const Eigen::MatrixXd along = covariance * fixed;
  return covariance - along * (fixed.transpose() * along).inverse() * along.transpose();
}

TouchVariances touchVariances(const RingResponse& ring, const TouchState& touch,
                              const Eigen::MatrixXd& covariance, double noise_strain) {
  const auto model = ring.linearised(touch, true);
  const Eigen::Matrix4d inverse = (model.toTouch.transpose() * model.toTouch).inverse();
  const Eigen::MatrixXd pull = inverse * model.toTouch.transpose() * model.toFinger;
  const TouchState noise = noise_strain * noise_strain * inverse.diagonal();
  return {noise, noise + (pull * covariance * pull.transpose()).diagonal()};
}

double fingerError(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const double noise_strain = drawing.config().gauges.noise_strain;
  const RingResponse built(drawing, result.deviations(), RingResponse::lastHarmonic(drawing));
  const Eigen::MatrixXd covariance = withoutConventions(drawing, result.covariance());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  const auto touches = judgedTouches(drawing);
  for (const TouchState& touch : touches) {
    const auto variances = touchVariances(built, touch, covariance, noise_strain);
    const double noises = noise_strain / (built.readings(touch) - built.zeros()).cwiseAbs().maxCoeff();
    sum += noises * noises * (variances.total.cwiseQuotient(variances.noise).array() - 1).head<3>().matrix();
  }
  return std::sqrt(sum.maxCoeff() / static_cast<double>(touches.size()));
}

ExpectedErrors expectedErrors(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const config::FingerConfig& config = drawing.config();
  const int last = RingResponse::lastHarmonic(drawing);
  const RingResponse built(drawing, result.deviations(), last);
  const RingResponse drawn(drawing, Eigen::VectorXd::Zero(drawing.unknowns()), last);
  const double radius_m = config.finger.outer_radius_m;
  ExpectedErrors sum{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  const auto touches = judgedTouches(drawing);
  for (const TouchState& touch : touches) {
    const auto variances = touchVariances(built, touch, result.covariance(), config.gauges.noise_strain);
    const TouchState found =
        refineTouch(drawn, {built.readings(touch), config.gauges.noise_strain, {}}, touch).touch;
    sum.before += inMetres(found - touch, radius_m).cwiseAbs2();
    sum.after += inMetres(variances.total.cwiseSqrt(), radius_m).cwiseAbs2();
    sum.bound += inMetres(variances.noise.cwiseSqrt(), radius_m).cwiseAbs2();
  }
  for (Eigen::Vector3d* each : {&sum.before, &sum.after, &sum.bound})
    *each = (*each / static_cast<double>(touches.size())).cwiseSqrt();
  return sum;
}

}  // namespace strainfinger::calibration
