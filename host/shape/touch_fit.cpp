#include "host/shape/touch_fit.hpp"

#include "host/base/angles.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace strainfinger::shape {
namespace {

using Eigen::Index;
using Eigen::Matrix4d;
using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr int kMostSteps = 100;
constexpr double kSmallStep = 1e-12;  ///< in strains, of those read
constexpr double kSmallGain = 1e-9;   ///< of the sum of squares: 1e-4 sigma of what is fitted
constexpr double kMostDamping = 1e12;

Touch moved(const TouchModel& model, const Touch& touch, const Vector4d& step) {
  return {touch.angle_rad + step[0], touch.normal_n_per_m + step[1], touch.tangential_n_per_m + step[2],
          std::clamp(touch.moment_rad2 + step[kMoment], model.leastMoment_rad2(), model.kMostMoment_rad2)};
}

bool isAtLimit(const TouchModel& model, double moment_rad2) {
  return moment_rad2 <= model.leastMoment_rad2() || moment_rad2 >= model.kMostMoment_rad2;
}

/// Of the damped normal equations; a moment that would leave its limits stays.
Vector4d stepOf(const TouchModel& model, const Touch& touch, const Matrix4d& curvature,
                const Vector4d& descent, double damping) {
  Matrix4d damped = curvature;
  damped.diagonal() *= 1 + damping;
  const Vector4d step = damped.ldlt().solve(descent);
  if (!isAtLimit(model, touch.moment_rad2) || moved(model, touch, step).moment_rad2 != touch.moment_rad2)
    return step;
  Vector4d kept = Vector4d::Zero();
  kept.head<kMoment>() = damped.topLeftCorner<kMoment, kMoment>().ldlt().solve(descent.head<kMoment>());
  return kept;
}

/// Scaled first: its members have different units.
Matrix4d inverseOf(const Matrix4d& curvature) {
  const Vector4d scale = curvature.diagonal().cwiseSqrt().cwiseInverse();
  const Matrix4d scaled = scale.asDiagonal() * curvature * scale.asDiagonal();
  const Eigen::LDLT<Matrix4d> factors(scaled);
  const bool isRegular = scale.allFinite() && factors.vectorD().minCoeff() > 1e-14;
  if (!isRegular) return Matrix4d::Constant(std::numeric_limits<double>::infinity());
  return scale.asDiagonal() * factors.solve(Matrix4d::Identity()) * scale.asDiagonal();
}

}  // namespace

TouchFit refine(const TouchModel& model, Profile profile, const VectorXd& strains, double noise,
                const Touch& start) {
  Touch touch = start;
  TouchStrains response = model.respond(profile, touch);
  VectorXd rest = strains - response.strains;
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
    const Matrix4d curvature = response.slopes.transpose() * response.slopes;
    const Vector4d move = stepOf(model, touch, curvature, response.slopes.transpose() * rest, damping);
    bool isDone = (response.slopes * move).norm() <= kSmallStep * strains.norm();
    const Touch next = moved(model, touch, move);
    TouchStrains nextResponse = model.respond(profile, next);
    const VectorXd nextRest = strains - nextResponse.strains;
    const double gain = rest.squaredNorm() - nextRest.squaredNorm();
    const bool isBetter = gain >= 0;
    isDone = isDone || (isBetter && gain <= kSmallGain * nextRest.squaredNorm());
    damping *= isBetter ? 0.1 : 10;
    if (isBetter) {
      touch = next;
      response = std::move(nextResponse);
      rest = nextRest;
    }
    if (isDone) break;
  }
  const Matrix4d curvature = response.slopes.transpose() * response.slopes;
  return {touch, noise * noise * inverseOf(curvature), rest.squaredNorm() / (noise * noise),
          isAtLimit(model, touch.moment_rad2)};
}

Vector4d difference(const Touch& a, const Touch& b) {
  return {shortWay_rad(a.angle_rad, b.angle_rad), a.normal_n_per_m - b.normal_n_per_m,
          a.tangential_n_per_m - b.tangential_n_per_m, a.moment_rad2 - b.moment_rad2};
}

bool areApart(const TouchFit& fit, const Touch& touch, double sigmas) {
  const Eigen::Array4d sigma = fit.covariance.diagonal().array().sqrt();
  return (difference(fit.touch, touch).array().abs() > sigmas * sigma).any();
}

}  // namespace strainfinger::shape
