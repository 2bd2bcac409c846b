#pragma once
// Levenberg-Marquardt as the Eigen library has it: MINPACK's, with an analytic Jacobian, in float.

#include <algorithm>
#include <cmath>

#include <unsupported/Eigen/NonLinearOptimization>

#include "host/bench/methods/gauss_newton.hpp"
#include "host/bench/methods/patch_table.hpp"

namespace strainfinger::bench {

/// The solver may try any position, of any size.
inline float roundTheRing(float position) {
  constexpr float kFarAway = 1e6f;
  if (!(std::abs(position) < kFarAway)) return 0;
  return position - static_cast<float>(static_cast<int>(position) / kGauges * kGauges);
}

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
  const RingResponse<float>& response_;
  const Ring<float>& strain_;
};

/// The same of a contact of some width, whose moment is the fourth unknown; beyond the table it counts as the
/// nearest that is in it.
class WideRingResiduals {
 public:
  WideRingResiduals(const PatchTable<float>& table, const Ring<float>& strain)
      : table_(table), strain_(strain) {}

  int values() const { return kGauges; }
  int operator()(const Eigen::VectorXf& at, Eigen::VectorXf& residuals) const {
    const auto contact = contactAt(at);
    for (int gauge = 0; gauge < kGauges; ++gauge) {
      const auto value = table_.at(static_cast<float>(gauge) - contact.place.position_pitch, contact);
      residuals[gauge] =
          at[1] * value.normal.value + at[2] * value.tangential.value - strain_[gaugeOf(gauge)];
    }
    return 0;
  }
  int df(const Eigen::VectorXf& at, Eigen::MatrixXf& jacobian) const {
    const auto contact = contactAt(at);
    for (int gauge = 0; gauge < kGauges; ++gauge) {
      const auto value = table_.at(static_cast<float>(gauge) - contact.place.position_pitch, contact);
      jacobian.row(gauge) << -(at[1] * value.normal.slope + at[2] * value.tangential.slope),
          value.normal.value, value.tangential.value,
          at[1] * value.normal.widening + at[2] * value.tangential.widening;
    }
    return 0;
  }

 private:
  static WidePlace<float> contactAt(const Eigen::VectorXf& at) {
    return {{roundTheRing(at[0]), at[1], at[2]}, at[3] > 0 ? std::min(at[3], 1.0f) : 0.0f};
  }

  const PatchTable<float>& table_;
  const Ring<float>& strain_;
};

/// Eigen's own stopping rules; with a relative tolerance of 1e-4 places are as exact as a float needs. Uses
/// the heap, as the library does.
template <typename Residuals>
Place<float> minimumOf(Residuals& residuals, Eigen::VectorXf& at) {
  constexpr int kEvaluations = 50;
  Eigen::LevenbergMarquardt<Residuals, float> solver(residuals);
  solver.parameters.xtol = 1e-4f;
  solver.parameters.ftol = 1e-5f;
  solver.parameters.maxfev = kEvaluations;
  solver.minimize(at);
  return {at[0], at[1], at[2]};
}

inline Place<float> levenbergMarquardt(const RingResponse<float>& response, const Ring<float>& strain,
                                       const Place<float>& start) {
  RingResiduals residuals(response, strain);
  Eigen::VectorXf at(3);
  at << start.position_pitch, start.normal, start.tangential;
  return minimumOf(residuals, at);
}

/// From a narrow contact.
inline Place<float> levenbergMarquardtOfWidth(const PatchTable<float>& table, const Ring<float>& strain,
                                              const Place<float>& start) {
  constexpr float kNarrow = 0.05f;
  WideRingResiduals residuals(table, strain);
  Eigen::VectorXf at(4);
  at << start.position_pitch, start.normal, start.tangential, kNarrow;
  return minimumOf(residuals, at);
}

}  // namespace strainfinger::bench
