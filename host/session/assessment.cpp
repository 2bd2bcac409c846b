#include "host/session/assessment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/angles.hpp"
#include "host/calibration/expected_error.hpp"
#include "host/calibration/joint_fit.hpp"
#include "host/model/pressure_profile.hpp"
#include "host/session/coverage.hpp"
#include "host/session/rules.hpp"

namespace strainfinger::session {
namespace {

using calibration::CalibrationResult, calibration::Drawing, calibration::RingResponse, calibration::TouchData,
    calibration::TouchEquations, calibration::TouchState;
using Eigen::MatrixXd, Eigen::VectorXd;

/// As hands press and rub a finger: loads [N/m], their lean, a width between narrow and wide ones.
constexpr std::array kHandLoads_n_per_m{8.0, 16.0, 30.0};
constexpr std::array kHandLeans{-0.4, 0.0, 0.4};
constexpr double kHandWidth_m = 2e-3;
constexpr double kPressLoad_n_per_m = 20;

/// What a covariance becomes by touches that are yet to be made.
class Prospect {
 public:
  explicit Prospect(const CalibrationResult& result)
      : result_(result),
        drawing_(result.drawing()),
        ring_(drawing_, result.deviations(), RingResponse::lastHarmonic(drawing_)),
        information_(calibration::inverseOf(result.covariance())) {}

  const RingResponse& ring() const { return ring_; }

  /// What one touch tells of the finger, its own unknowns not being known but for `known` of them.
  MatrixXd informationOf(const TouchState& touch, const TouchState& knownWeight) const {
    const VectorXd readings = ring_.readings(touch);
    const double peak = (readings - ring_.zeros()).cwiseAbs().maxCoeff();
    const double sigma_strain =
        std::hypot(drawing_.config().gauges.noise_strain, result_.modelError().value * peak);
    const TouchData data{readings, sigma_strain, {touch, knownWeight}};
    return TouchEquations(ring_, data, touch, true).fingerInformation();
  }

  /// The mean of what the touches of a hand in an arc tell.
  MatrixXd informationOfArc(int arc) const {
    const config::FingerConfig& config = drawing_.config();
    const double moment_rad2 = model::momentOfWidth(kHandWidth_m / config.finger.outer_radius_m);
    const double place_rad = middleOf_rad(config.gauges, arc);
    MatrixXd sum = MatrixXd::Zero(drawing_.unknowns(), drawing_.unknowns());
    for (const double load : kHandLoads_n_per_m)
      for (const double lean : kHandLeans)
        sum += informationOf({place_rad, load, lean * load, moment_rad2}, TouchState::Zero());
    return sum / static_cast<double>(kHandLoads_n_per_m.size() * kHandLeans.size());
  }

  MatrixXd covarianceWith(const MatrixXd& more) const { return calibration::inverseOf(information_ + more); }

 private:
  const CalibrationResult& result_;
  const Drawing& drawing_;
  RingResponse ring_;
  MatrixXd information_;
};

/// Errors of the judged touches as a function of the finger's covariance: mean variances over the bound's.
class Yardstick {
 public:
  Yardstick(const CalibrationResult& result, const RingResponse& ring) : drawing_(result.drawing()) {
    const double noise = drawing_.config().gauges.noise_strain;
    const auto touches = calibration::judgedTouches(drawing_);
    const Eigen::Index unknowns = drawing_.unknowns();
    pulls_.fill(MatrixXd::Zero(unknowns, unknowns));
    loadScale_ = VectorXd::Zero(unknowns);
    for (const TouchState& touch : touches) {
      const TouchEquations at(ring, touch, noise);
      const Eigen::Matrix4d byNoise = at.matrix.inverse();
      const MatrixXd pull = at.pull();
      for (std::size_t i = 0; i < pulls_.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        pulls_[i] += pull.row(row).transpose() * pull.row(row);
        noise_[row] += byNoise(row, row);
      }
      loadScale_ += pull.row(calibration::kNormalLoad).transpose() / touch[calibration::kNormalLoad];
    }
    for (MatrixXd& pull : pulls_) pull /= static_cast<double>(touches.size());
    noise_ /= static_cast<double>(touches.size());
    loadScale_ /= static_cast<double>(touches.size());
  }

  /// [rad^2], [(N/m)^2], [(N/m)^2].
  Eigen::Vector3d variances(const MatrixXd& covariance) const {
    const MatrixXd given = calibration::withoutConventions(drawing_, covariance);
    Eigen::Vector3d sum = noise_;
    for (Eigen::Index i = 0; i < 3; ++i)
      sum[i] += pulls_[static_cast<std::size_t>(i)].cwiseProduct(given).sum();
    return sum;
  }
  const Eigen::Vector3d& noise() const { return noise_; }

  /// Of the relative error that the normal loads have in common. The modulus' own is no measure of it: gains
  /// and depths that are all off make up for it.
  double sigmaOfLoads(const MatrixXd& covariance) const {
    return std::sqrt(loadScale_.dot(covariance * loadScale_));
  }

  /// RMS of the three errors over their bounds.
  double total(const MatrixXd& covariance) const {
    return std::sqrt(variances(covariance).cwiseQuotient(noise_).mean());
  }

 private:
  const Drawing& drawing_;
  std::array<MatrixXd, 3> pulls_;
  Eigen::Vector3d noise_ = Eigen::Vector3d::Zero();
  VectorXd loadScale_;  ///< relative error of the mean normal load by a deviation of 1 of each unknown
};

double sigmaOfMeanAngle_deg(const Drawing& drawing, const MatrixXd& covariance) {
  VectorXd mean = VectorXd::Zero(drawing.unknowns());
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    mean[Drawing::at(gauge, calibration::kAngleOffset)] = 1.0 / drawing.gauges();
  return drawing.tolerance(calibration::kAngleOffset) * std::sqrt(mean.dot(covariance * mean)) / kRadPerDeg;
}

Eigen::Vector3d errorsOf(const Eigen::Vector3d& variances, double radius_m) {
  const Eigen::Vector3d sigma = variances.cwiseSqrt();
  return {radius_m * sigma[0], sigma[1], sigma[2]};
}

}  // namespace

double Assessment::bestGain() const {
  return std::max(gainAllAround, *std::max_element(arcGains.begin(), arcGains.end()));
}

Assessment assess(const CalibrationResult& result, const calibration::KnownErrors& errors) {
  const Drawing& drawing = result.drawing();
  const Prospect prospect(result);
  const Yardstick yardstick(result, prospect.ring());
  const double radius_m = drawing.config().finger.outer_radius_m;
  const double batch = kGoals.batch;
  Assessment found;
  found.rows = result.rows().size();
  found.fitted = static_cast<std::size_t>(result.count(calibration::RowUse::kFitted));
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    found.gauges.push_back({result.gain(gauge).sigma, result.zero_strain(gauge).sigma,
                            result.angleOffset_deg(gauge).sigma, result.depthOffset_m(gauge).sigma});
  found.errors = {calibration::expectedErrors(result).before,
                  errorsOf(yardstick.variances(result.covariance()), radius_m),
                  errorsOf(yardstick.noise(), radius_m)};
  found.unitOfForce = yardstick.sigmaOfLoads(result.covariance());
  if (result.isDirectionKnown()) found.zeroOfAngle_deg = sigmaOfMeanAngle_deg(drawing, result.covariance());
  const double now = yardstick.total(result.covariance());
  const int arcs = 2 * drawing.gauges();
  MatrixXd around = MatrixXd::Zero(drawing.unknowns(), drawing.unknowns());
  for (int arc = 0; arc < arcs; ++arc) {
    const MatrixXd information = prospect.informationOfArc(arc);
    around += information / arcs;
    found.arcGains.push_back(1 - yardstick.total(prospect.covarianceWith(batch * information)) / now);
  }
  found.gainAllAround = 1 - yardstick.total(prospect.covarianceWith(batch * around)) / now;
  TouchState loadIsKnown = TouchState::Zero();
  loadIsKnown[calibration::kNormalLoad] = 1 / std::max(1e-6, errors.load * kPressLoad_n_per_m);
  const double moment_rad2 = model::momentOfWidth(kHandWidth_m / radius_m);
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) {
    const TouchState press{drawing.config().gauges.angle_rad(gauge), kPressLoad_n_per_m, 0, moment_rad2};
    found.unitAfterPress.push_back(
        yardstick.sigmaOfLoads(prospect.covarianceWith(prospect.informationOf(press, loadIsKnown))));
  }
  return found;
}

}  // namespace strainfinger::session
