#include "host/calibration/touch_equations.hpp"

#include <Eigen/Dense>

#include "host/base/angles.hpp"

namespace strainfinger::calibration {

using Eigen::MatrixXd, Eigen::VectorXd;

TouchState TouchPrior::residuals(const TouchState& touch) const {
  TouchState difference = value - touch;
  difference[kPlace] = shortWay_rad(difference[kPlace], 0);
  return weight.cwiseProduct(difference);
}

TouchEquations::TouchEquations(const RingResponse& ring, const TouchData& data, const TouchState& touch,
                               bool withFinger) {
  const auto model = ring.linearised(touch, withFinger);
  const double weight = 1 / data.sigma_strain;
  const TouchState known = data.prior.residuals(touch);
  residual = weight * (data.readings - model.readings);
  toTouch = weight * model.toTouch;
  if (withFinger) toFinger = weight * model.toFinger;
  matrix = toTouch.transpose() * toTouch;
  matrix.diagonal() += data.prior.weight.cwiseAbs2();
  gradient = toTouch.transpose() * residual + data.prior.weight.cwiseProduct(known);
  chiSquared = residual.squaredNorm() + known.squaredNorm();
}

TouchEquations::TouchEquations(const RingResponse& ring, const TouchState& touch, double sigma_strain)
    : TouchEquations(ring, {ring.readings(touch), sigma_strain, {}}, touch, true) {}

MatrixXd TouchEquations::pull() const { return matrix.ldlt().solve(toTouch.transpose() * toFinger); }

MatrixXd TouchEquations::fingerInformation() const {
  const MatrixXd left = toFinger - toTouch * pull();
  return toFinger.transpose() * left;
}

VectorXd TouchEquations::fingerGradient() const {
  const TouchState step = matrix.ldlt().solve(gradient);
  const VectorXd left = residual - toTouch * step;
  return toFinger.transpose() * left;
}

}  // namespace strainfinger::calibration
