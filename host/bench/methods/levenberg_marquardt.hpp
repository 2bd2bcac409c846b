#pragma once
// Levenberg-Marquardt as the Eigen library has it: MINPACK's, with an analytic Jacobian, in float.

#include <unsupported/Eigen/NonLinearOptimization>

#include "host/bench/methods/gauss_newton.hpp"

namespace strainfinger::bench {

/// Over all gauges; the unknowns are the members of Place.
class RingResiduals {
 public:
  RingResiduals(const RingResponse<float>& response, const Ring<float>& strain)
      : response_(response), strain_(strain) {}

  int values() const { return kGauges; }
  int operator()(const Eigen::VectorXf& at, Eigen::VectorXf& residuals) const {
    const float position = roundTheRing(at[0]);
    for (int gauge = 0; gauge < kGauges; ++gauge) {
      const auto value = response_.at(static_cast<float>(gauge) - position);
      residuals[gauge] = at[1] * value.normal + at[2] * value.tangential - strain_[gaugeOf(gauge)];
    }
    return 0;
  }
  int df(const Eigen::VectorXf& at, Eigen::MatrixXf& jacobian) const {
    const float position = roundTheRing(at[0]);
    for (int gauge = 0; gauge < kGauges; ++gauge) {
      const auto value = response_.at(static_cast<float>(gauge) - position);
      jacobian.row(gauge) << -(at[1] * value.normalSlope + at[2] * value.tangentialSlope), value.normal,
          value.tangential;
    }
    return 0;
  }

 private:
  /// The solver may try any number, of any size.
  static float roundTheRing(float position) {
    constexpr float kFarAway = 1e6f;
    if (!(std::abs(position) < kFarAway)) return 0;
    return position - static_cast<float>(static_cast<int>(position) / kGauges * kGauges);
  }

  const RingResponse<float>& response_;
  const Ring<float>& strain_;
};

/// Eigen's own stopping rules; with a relative tolerance of 1e-4 places are as exact as a float needs. Uses
/// the heap, as the library does.
inline Place<float> levenbergMarquardt(const RingResponse<float>& response, const Ring<float>& strain,
                                       const Place<float>& start) {
  constexpr int kEvaluations = 50;
  RingResiduals residuals(response, strain);
  Eigen::LevenbergMarquardt<RingResiduals, float> solver(residuals);
  solver.parameters.xtol = 1e-4f;
  solver.parameters.ftol = 1e-5f;
  solver.parameters.maxfev = kEvaluations;
  Eigen::VectorXf at = Eigen::Vector3f(start.position_pitch, start.normal, start.tangential);
  solver.minimize(at);
  return {at[0], at[1], at[2]};
}

}  // namespace strainfinger::bench
