#include "host/shape/touch_model.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/config/strained_gauges.hpp"

namespace strainfinger::shape {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Columns of cosines above as many of sines: what TouchModel's matrices are multiplied by.
MatrixXd stacked(const MatrixXd& cosines, const MatrixXd& sines) {
  MatrixXd both(cosines.rows() + sines.rows(), cosines.cols());
  both << cosines, sines;
  return both;
}

std::vector<model::ImpulseResponse> linesOf(const config::FingerConfig& config) {
  std::vector<model::ImpulseResponse> lines;
  for (int i = 0; i < config.gauges.count; ++i)
    lines.emplace_back(config.finger.annulus(), config.calibrated(i).radius_m, config.gauges.component,
                       config.gauges.arc_length_m);
  return lines;
}

}  // namespace

TouchModel::TouchModel(const config::FingerConfig& config)
    : angles_rad_(config.gauges.count), outerRadius_m_(config.finger.outer_radius_m) {
  const auto lines = linesOf(config);
  int last = 0;
  for (const model::ImpulseResponse& line : lines) last = std::max(last, line.harmonics());
  orders_ = VectorXd::LinSpaced(last + 1, 0, last);
  normal_ = tangential_ = MatrixXd::Zero(config.gauges.count, 2 * orders_.size());
  VectorXd depths(config.gauges.count);
  for (int i = 0; i < config.gauges.count; ++i) {
    const model::PlacedGauge gauge = config.calibrated(i);
    angles_rad_[i] = gauge.angle_rad;
    depths[i] = 1 - gauge.radius_m / outerRadius_m_;
    addGauge(i, lines[static_cast<std::size_t>(i)]);
  }
  config::requireStrain(config,
                        std::max(normal_.lpNorm<Eigen::Infinity>(), tangential_.lpNorm<Eigen::Infinity>()));
  depth_ = depths.mean();
  leastDepth_ = depths.minCoeff();
}

/// Harmonics beyond those that the gauge feels stay 0.
void TouchModel::addGauge(Index gauge, const model::ImpulseResponse& line) {
  const Index felt = line.harmonics() + 1, sinesFrom = orders_.size();
  const VectorXd phases = angles_rad_[gauge] * orders_.head(felt);
  const VectorXd cosines = phases.array().cos(), sines = phases.array().sin();
  auto even = (line.isEvenInNormal() ? normal_ : tangential_).row(gauge);
  even.head(felt) = cosines.cwiseProduct(line.even()).transpose();
  even.segment(sinesFrom, felt) = sines.cwiseProduct(line.even()).transpose();
  auto odd = (line.isEvenInNormal() ? tangential_ : normal_).row(gauge);
  odd.head(felt) = sines.cwiseProduct(line.odd()).transpose();
  odd.segment(sinesFrom, felt) = -cosines.cwiseProduct(line.odd()).transpose();
}

TouchStrains TouchModel::respond(Profile profile, const Touch& touch) const {
  const Index count = orders_.size();
  VectorXd spread(count), spreadSlope(count);
  for (Index n = 0; n < count; ++n) {
    const SpreadFactor factor = spreadFactor(profile, static_cast<int>(n), touch.moment_rad2);
    spread[n] = factor.value;
    spreadSlope[n] = factor.slope;
  }
  const VectorXd phases = orders_ * touch.angle_rad;
  const VectorXd cosines = phases.array().cos(), sines = phases.array().sin();
  // Columns: the load, moved, widened.
  MatrixXd onCosines(count, 3), onSines(count, 3);
  onCosines << cosines, -orders_.cwiseProduct(sines), cosines;
  onSines << sines, orders_.cwiseProduct(cosines), sines;
  MatrixXd weights(count, 3);
  weights << spread, spread, spreadSlope;
  const MatrixXd load = stacked(onCosines.cwiseProduct(weights), onSines.cwiseProduct(weights));
  const MatrixXd ofNormal = normal_ * load, ofTangential = tangential_ * load;
  const MatrixXd ofBoth = touch.normal_n_per_m * ofNormal + touch.tangential_n_per_m * ofTangential;
  TouchStrains result;
  result.slopes.resize(gauges(), 4);
  result.slopes << ofBoth.col(1), ofNormal.col(0), ofTangential.col(0), ofBoth.col(2);
  result.strains = ofBoth.col(0);
  return result;
}

MatrixXd TouchModel::normalLineStrains(const VectorXd& angles_rad) const {
  const MatrixXd phases = orders_ * angles_rad.transpose();
  return normal_ * stacked(phases.array().cos(), phases.array().sin());
}

double TouchModel::leastMoment_rad2() const {
  const double root = std::log1p(-leastDepth_) / 4;
  return -root * root;
}

}  // namespace strainfinger::shape
