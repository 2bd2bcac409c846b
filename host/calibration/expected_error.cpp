#include "host/calibration/expected_error.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
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

std::string judgedTouchesText() {
  return fmt::format("touches of {} N/m, {} mm wide", kLoad_n_per_m, 1e3 * kWidth_m);
}

Eigen::MatrixXd withoutConventions(const Drawing& drawing, const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd given = covariance;
  const auto give = [&](const Eigen::VectorXd& direction) {
    const Eigen::VectorXd along = given * direction;
    given -= along * along.transpose() / direction.dot(along);
  };
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(drawing.unknowns());
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) turn[Drawing::at(gauge, kAngleOffset)] = 1;
  give(turn);
  give(Eigen::VectorXd::Unit(drawing.unknowns(), drawing.at(kShearModulus)));
  return given;
}

TouchVariances touchVariances(const RingResponse& ring, const TouchState& touch,
                              const Eigen::MatrixXd& covariance, double noise_strain) {
  const TouchEquations at(ring, touch, noise_strain);
  const Eigen::MatrixXd pull = at.pull();
  const TouchState noise = at.matrix.inverse().diagonal();
  return {noise, noise + (pull * covariance * pull.transpose()).diagonal()};
}

CalibrationErrors calibrationErrors(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const double radius_m = drawing.config().finger.outer_radius_m;
  const RingResponse built(drawing, result.deviations(), RingResponse::lastHarmonic(drawing));
  TouchState sum = TouchState::Zero();
  const auto touches = judgedTouches(drawing);
  for (const TouchState& touch : touches) {
    const auto variances =
        touchVariances(built, touch, result.covariance(), drawing.config().gauges.noise_strain);
    sum += variances.total - variances.noise;
  }
  const TouchState error = (sum / static_cast<double>(touches.size())).cwiseMax(0).cwiseSqrt();
  return {.place_m = radius_m * error[kPlace],
          .load = std::max(error[kNormalLoad], error[kTangentialLoad]) / kLoad_n_per_m,
          .moment_m2 = radius_m * radius_m * error[kMoment]};
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
    const Eigen::Vector3d after = inMetres(variances.total.cwiseSqrt(), radius_m).cwiseAbs2();
    sum.before += inMetres(found - touch, radius_m).cwiseAbs2() + after;
    sum.after += after;
    sum.bound += inMetres(variances.noise.cwiseSqrt(), radius_m).cwiseAbs2();
  }
  for (Eigen::Vector3d* each : {&sum.before, &sum.after, &sum.bound})
    *each = (*each / static_cast<double>(touches.size())).cwiseSqrt();
  return sum;
}

}  // namespace strainfinger::calibration
