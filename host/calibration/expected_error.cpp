#include "host/calibration/expected_error.hpp"

#include <Eigen/Dense>
#include <numbers>

#include "host/calibration/touch_fit.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::calibration {
namespace {

constexpr double kLoad_n_per_m = 30, kWidth_m = 2e-3;
constexpr int kPlacesPerGauge = 6;

}  // namespace

TouchVariances touchVariances(const RingResponse& ring, const TouchState& touch,
                              const Eigen::MatrixXd& covariance, double noise_strain) {
  const auto model = ring.linearised(touch, true);
  const Eigen::Matrix4d inverse = (model.toTouch.transpose() * model.toTouch).inverse();
  const Eigen::MatrixXd pull = inverse * model.toTouch.transpose() * model.toFinger;
  const TouchState noise = noise_strain * noise_strain * inverse.diagonal();
  return {noise, noise + (pull * covariance * pull.transpose()).diagonal()};
}

ExpectedErrors expectedErrors(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const config::FingerConfig& config = drawing.config();
  const int last = RingResponse::lastHarmonic(drawing);
  const RingResponse built(drawing, result.deviations(), last);
  const RingResponse drawn(drawing, Eigen::VectorXd::Zero(drawing.unknowns()), last);
  const double radius_m = config.finger.outer_radius_m;
  const double moment_rad2 = model::momentOfWidth(kWidth_m / radius_m);
  ExpectedErrors sum{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  int touches = 0;
  for (int place = 0; place < kPlacesPerGauge * drawing.gauges(); ++place)
    for (const double lean : {-0.5, 0.1, 0.5}) {
      const double place_rad = 2 * std::numbers::pi * place / (kPlacesPerGauge * drawing.gauges());
      const TouchState touch{place_rad, kLoad_n_per_m, lean * kLoad_n_per_m, moment_rad2};
      const auto variances = touchVariances(built, touch, result.covariance(), config.gauges.noise_strain);
      const TouchState found =
          refineTouch(drawn, {built.readings(touch), config.gauges.noise_strain, {}}, touch).touch;
      sum.before += inMetres(found - touch, radius_m).cwiseAbs2();
      sum.after += inMetres(variances.total.cwiseSqrt(), radius_m).cwiseAbs2();
      sum.bound += inMetres(variances.noise.cwiseSqrt(), radius_m).cwiseAbs2();
      ++touches;
    }
  for (Eigen::Vector3d* each : {&sum.before, &sum.after, &sum.bound}) *each = (*each / touches).cwiseSqrt();
  return sum;
}

}  // namespace strainfinger::calibration
