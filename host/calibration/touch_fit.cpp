#include "host/calibration/touch_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

constexpr int kPlacesPerPitch = 12;
constexpr int kMomentNodes = 6;
constexpr std::size_t kRefined = 4;  ///< of the best nodes, each of another width

/// A start may be away from a place that is known: by standard deviations, and by so much anyway.
constexpr double kMostAway = 5, kMostAway_rad = 0.2;

/// Touches that are further apart are not the same minimum of chi-squared.
constexpr double kApart_rad = 5e-3, kApart_rad2 = 1e-3;

constexpr int kMostIterations = 30;
constexpr double kEnoughGain = 1e-3;  ///< of chi-squared: far less than noise makes of it

/// Normal equations of a touch's readings and prior.
struct NormalEquations {
  Eigen::Matrix4d matrix;
  Eigen::Vector4d gradient;  ///< of half of chi-squared, downhill
  double chiSquared;

  NormalEquations(const RingResponse& ring, const TouchData& data, const TouchState& touch) {
    const auto model = ring.linearised(touch, false);
    const double weight = 1 / data.sigma_strain;
    const VectorXd residuals = weight * (data.readings - model.readings);
    const TouchState known = data.prior.residuals(touch);
    matrix = weight * weight * model.toTouch.transpose() * model.toTouch;
    matrix.diagonal() += data.prior.weight.cwiseAbs2();
    gradient = weight * model.toTouch.transpose() * residuals + data.prior.weight.cwiseProduct(known);
    chiSquared = residuals.squaredNorm() + known.squaredNorm();
  }
};

bool isBetter(const TouchFit& a, const TouchFit& b) { return a.chiSquared < b.chiSquared; }

bool isAnother(const TouchState& a, const TouchState& b) {
  return std::abs(std::remainder(a[kPlace] - b[kPlace], 2 * pi)) > kApart_rad ||
         std::abs(a[kMoment] - b[kMoment]) > kApart_rad2;
}

TouchState damped(const NormalEquations& equations, double damping) {
  Eigen::Matrix4d matrix = equations.matrix;
  matrix.diagonal() *= 1 + damping;
  return matrix.ldlt().solve(equations.gradient);
}

}  // namespace

TouchState TouchPrior::residuals(const TouchState& touch) const {
  TouchState difference = value - touch;
  difference[kPlace] = std::remainder(difference[kPlace], 2 * pi);
  return weight.cwiseProduct(difference);
}

TouchFit refineTouch(const RingResponse& ring, const TouchData& data, const TouchState& start) {
  TouchState touch = start;
  NormalEquations here(ring, data, touch);
  double damping = 1e-3;
  for (int i = 0; i < kMostIterations && damping < 1e8; ++i) {
    const TouchState step = damped(here, damping);
    const NormalEquations there(ring, data, touch + step);
    if (!(there.chiSquared < here.chiSquared)) {
      if (step.dot(here.gradient) < kEnoughGain) break;
      damping *= 10;
      continue;
    }
    const double gained = here.chiSquared - there.chiSquared;
    touch += step;
    here = there;
    damping /= 10;
    if (gained < kEnoughGain) break;
  }
  return {touch, here.chiSquared};
}

TouchSearch::TouchSearch(const RingResponse& ring, double friction, double mostMoment_rad2)
    : friction_(friction), moments_(kMomentNodes) {
  const int places = kPlacesPerPitch * ring.gauges();
  orthonormal_.resize(ring.gauges(), 2 * places * kMomentNodes);
  for (int place = 0; place < places; ++place)
    for (int k = 0; k < kMomentNodes; ++k) {
      const double width = (k + 0.5) / kMomentNodes;
      Node node{2 * pi * place / places, mostMoment_rad2 * width * width, {}, {}};
      node.unit = ring.unitReadings(node.place_rad, node.moment_rad2, 1.5 * node.moment_rad2);
      const Eigen::HouseholderQR<Eigen::MatrixX2d> qr(node.unit);
      const Index first = 2 * static_cast<Index>(nodes_.size());
      orthonormal_.middleCols<2>(first) = qr.householderQ() * MatrixXd::Identity(ring.gauges(), 2);
      const Eigen::Matrix2d triangle = qr.matrixQR().topRows<2>().triangularView<Eigen::Upper>();
      node.toLoads = triangle.inverse();
      nodes_.push_back(node);
    }
}

TouchState TouchSearch::stateAt(std::size_t node, const VectorXd& strains) const {
  const Index first = 2 * static_cast<Index>(node);
  const Eigen::Vector2d loads =
      nodes_[node].toLoads * (orthonormal_.middleCols<2>(first).transpose() * strains);
  return {nodes_[node].place_rad, loads[0], loads[1], nodes_[node].moment_rad2};
}

bool TouchSearch::isAdmissible(const TouchState& touch, const TouchPrior& prior) const {
  const bool presses =
      touch[kNormalLoad] > 0 && std::abs(touch[kTangentialLoad]) <= (1 + friction_) * touch[kNormalLoad];
  const double away = std::abs(prior.residuals(touch)[kPlace]);
  return presses && (away <= kMostAway || away <= kMostAway_rad * prior.weight[kPlace]);
}

std::vector<TouchState> TouchSearch::starts(const VectorXd& strains, const TouchPrior& prior) const {
  const VectorXd along = orthonormal_.transpose() * strains;
  struct Candidate {
    double explained = -1;
    TouchState touch = TouchState::Zero();
  };
  std::vector<Candidate> best(moments_);
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const double explained = along.segment<2>(2 * static_cast<Index>(node)).squaredNorm();
    Candidate& rival = best[node % moments_];
    if (explained <= rival.explained) continue;
    const TouchState touch = stateAt(node, strains);
    if (isAdmissible(touch, prior)) rival = {explained, touch};
  }
  std::sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.explained > b.explained; });
  std::vector<TouchState> starts;
  for (std::size_t i = 0; i < kRefined; ++i)
    if (best[i].explained >= 0) starts.push_back(best[i].touch);
  return starts;
}

TouchState TouchSearch::guess(const VectorXd& strains) const {
  const auto best = starts(strains, {});
  return best.empty() ? TouchState::Zero() : best.front();
}

double TouchSearch::unexplainedShare(const VectorXd& strains) const {
  const VectorXd along = orthonormal_.transpose() * strains;
  double best = 0;
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const double explained = along.segment<2>(2 * static_cast<Index>(node)).squaredNorm();
    if (explained > best && isAdmissible(stateAt(node, strains), {})) best = explained;
  }
  return 1 - best / strains.squaredNorm();
}

TouchFit TouchSearch::find(const RingResponse& ring, const TouchData& data) const {
  std::vector<TouchFit> fits;
  for (const TouchState& start : starts(data.readings - ring.zeros(), data.prior))
    fits.push_back(refineTouch(ring, data, start));
  if (fits.empty()) return {TouchState::Zero(), std::numeric_limits<double>::infinity(), 0};
  TouchFit found = *std::min_element(fits.begin(), fits.end(), isBetter);
  for (const TouchFit& fit : fits)
    if (isAnother(fit.touch, found.touch))
      found.rivalGap = std::min(found.rivalGap, fit.chiSquared - found.chiSquared);
  return found;
}

}  // namespace strainfinger::calibration
