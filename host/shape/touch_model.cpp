#include "host/shape/touch_model.hpp"

#include <cmath>

namespace strainfinger::shape {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// sum even_n cos n psi + odd_n sin n psi, psi = a gauge's angle minus the touch's.
struct TouchModel::Series {
  VectorXd even, odd;
};

/// Cosines and sines of n times the touch's angle.
struct TouchModel::Turn {
  Eigen::ArrayXd cosine, sine;
};

TouchModel::TouchModel(const config::Finger& finger, const config::Gauges& gauges)
    : line_(finger.annulus(), gauges.radius_m, gauges.component, gauges.arc_length_m),
      angles_rad_(gauges.count),
      orders_(VectorXd::LinSpaced(line_.harmonics() + 1, 0, line_.harmonics())),
      outerRadius_m_(finger.outer_radius_m),
      depth_(1 - gauges.radius_m / finger.outer_radius_m) {
  for (int i = 0; i < gauges.count; ++i) angles_rad_[i] = gauges.angle_rad(i);
  const MatrixXd phases = angles_rad_ * orders_.transpose();
  cosines_ = phases.array().cos();
  sines_ = phases.array().sin();
}

TouchModel::Turn TouchModel::turnBy(double angle_rad) const {
  const Eigen::ArrayXd phases = orders_.array() * angle_rad;
  return {phases.cos(), phases.sin()};
}

VectorXd TouchModel::strainsOf(const Series& series, const Turn& turn) const {
  const auto even = series.even.array(), odd = series.odd.array();
  return cosines_ * (even * turn.cosine - odd * turn.sine).matrix() +
         sines_ * (even * turn.sine + odd * turn.cosine).matrix();
}

TouchStrains TouchModel::respond(Profile profile, const Touch& touch) const {
  const Index count = orders_.size();
  VectorXd spread(count), spreadSlope(count);
  for (Index n = 0; n < count; ++n) {
    const SpreadFactor factor = spreadFactor(profile, static_cast<int>(n), touch.moment_rad2);
    spread[n] = factor.value;
    spreadSlope[n] = factor.slope;
  }
  const VectorXd even = line_.even().cwiseProduct(spread), odd = line_.odd().cwiseProduct(spread);
  const bool isEven = line_.isEvenInNormal();
  const double evenLoad = isEven ? touch.normal_n_per_m : touch.tangential_n_per_m;
  const double oddLoad = isEven ? touch.tangential_n_per_m : touch.normal_n_per_m;
  const VectorXd none = VectorXd::Zero(count);
  const Series evenPart{even, none}, oddPart{none, odd};
  const Series moved{-oddLoad * orders_.cwiseProduct(odd), evenLoad * orders_.cwiseProduct(even)};
  const Series widened{evenLoad * line_.even().cwiseProduct(spreadSlope),
                       oddLoad * line_.odd().cwiseProduct(spreadSlope)};
  const Turn turn = turnBy(touch.angle_rad);
  TouchStrains result;
  result.slopes.resize(gauges(), 4);
  result.slopes.col(0) = strainsOf(moved, turn);
  result.slopes.col(1) = strainsOf(isEven ? evenPart : oddPart, turn);
  result.slopes.col(2) = strainsOf(isEven ? oddPart : evenPart, turn);
  result.slopes.col(3) = strainsOf(widened, turn);
  result.strains =
      touch.normal_n_per_m * result.slopes.col(1) + touch.tangential_n_per_m * result.slopes.col(2);
  return result;
}

MatrixXd TouchModel::normalLineStrains(const VectorXd& angles_rad) const {
  const VectorXd none = VectorXd::Zero(orders_.size());
  const Series series = line_.isEvenInNormal() ? Series{line_.even(), none} : Series{none, line_.odd()};
  MatrixXd strains(gauges(), angles_rad.size());
  for (Index k = 0; k < angles_rad.size(); ++k) strains.col(k) = strainsOf(series, turnBy(angles_rad[k]));
  return strains;
}

double TouchModel::leastMoment_rad2() const {
  const double root = std::log1p(-depth_) / 4;
  return -root * root;
}

}  // namespace strainfinger::shape
