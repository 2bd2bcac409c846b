#include "host/calibration/touch_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "host/base/angles.hpp"
#include "host/model/pressure_profile.hpp"

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

/// Of a load's energy: with less at the other gauges, these don't tell it.
constexpr double kLeastLeft = 1e-6;

bool isBetter(const TouchFit& a, const TouchFit& b) { return a.chiSquared < b.chiSquared; }

bool isAnother(const TouchState& a, const TouchState& b) {
  return std::abs(shortWay_rad(a[kPlace], b[kPlace])) > kApart_rad ||
         std::abs(a[kMoment] - b[kMoment]) > kApart_rad2;
}

/// Coordinates of the least squares along two orthonormal directions when one gauge, of which they have the
/// row `own`, is left out: their Gram matrix is then I - own^T own (Sherman & Morrison).
Eigen::Vector2d withoutGauge(const Eigen::RowVector2d& own, const Eigen::Vector2d& projected) {
  const double left = std::max(kLeastLeft, 1 - own.squaredNorm());
  return projected + own.transpose() * (own.dot(projected.transpose()) / left);
}

/// The step that a part of each unknown's own curvature shortens.
TouchState damped(const TouchEquations& equations, double damping) {
  Eigen::Matrix4d matrix = equations.matrix;
  matrix.diagonal() *= 1 + damping;
  return matrix.ldlt().solve(equations.gradient);
}

}  // namespace

TouchFit refineTouch(const RingResponse& ring, const TouchData& data, const TouchState& start) {
  TouchState touch = start;
  TouchEquations here(ring, data, touch, false);
  double damping = 1e-3;
  for (int i = 0; i < kMostIterations && damping < 1e8; ++i) {
    const TouchState step = damped(here, damping);
    TouchEquations there(ring, data, touch + step, false);
    if (!(there.chiSquared < here.chiSquared)) {
      if (step.dot(here.gradient) < kEnoughGain) break;
      damping *= 10;
      continue;
    }
    const double gained = here.chiSquared - there.chiSquared;
    touch += step;
    here = std::move(there);
    damping /= 10;
    if (gained < kEnoughGain) break;
  }
  return {touch, here.chiSquared};
}

TouchFit refineTouches(const RingResponse& ring, const TouchData& data,
                       const std::vector<TouchState>& starts) {
  std::vector<TouchFit> fits;
  for (const TouchState& start : starts) fits.push_back(refineTouch(ring, data, start));
  if (fits.empty()) return {TouchState::Zero(), std::numeric_limits<double>::infinity(), 0};
  TouchFit found = *std::min_element(fits.begin(), fits.end(), isBetter);
  for (const TouchFit& fit : fits) {
    const double gap = fit.chiSquared - found.chiSquared;
    if (gap >= found.rivalGap || !isAnother(fit.touch, found.touch)) continue;
    found.rivalGap = gap;
    found.rival = fit.touch;
  }
  return found;
}

TouchSearch::TouchSearch(const RingResponse& ring, const config::FingerConfig& config)
    : friction_(config.contact.friction_coefficient), moments_(kMomentNodes) {
  const double mostMoment_rad2 =
      model::momentOfWidth(config.contact.largest_width_m / config.finger.outer_radius_m);
  const int places = kPlacesPerPitch * ring.gauges();
  orthonormal_.resize(ring.gauges(), 2 * places * kMomentNodes);
  std::vector<double> moments_rad2;
  std::vector<RingResponse::Spread> spreads;
  for (int k = 0; k < kMomentNodes; ++k) {
    const double width = (k + 0.5) / kMomentNodes;
    moments_rad2.push_back(mostMoment_rad2 * width * width);
    spreads.push_back(ring.spread(moments_rad2.back(), 1.5 * moments_rad2.back()));
  }
  for (int place = 0; place < places; ++place)
    for (std::size_t k = 0; k < moments_; ++k) {
      Node node{2 * pi * place / places, moments_rad2[k], {}};
      const Eigen::HouseholderQR<Eigen::MatrixX2d> qr(ring.unitReadings(node.place_rad, spreads[k]));
      const Index first = 2 * static_cast<Index>(nodes_.size());
      orthonormal_.middleCols<2>(first) = qr.householderQ() * MatrixXd::Identity(ring.gauges(), 2);
      const Eigen::Matrix2d triangle = qr.matrixQR().topRows<2>().triangularView<Eigen::Upper>();
      node.toLoads = triangle.inverse();
      nodes_.push_back(node);
    }
}

TouchState TouchSearch::stateAt(std::size_t node, const Eigen::Vector2d& coordinates) const {
  const Eigen::Vector2d loads = nodes_[node].toLoads * coordinates;
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
    const Eigen::Vector2d coordinates = along.segment<2>(2 * static_cast<Index>(node));
    const double explained = coordinates.squaredNorm();
    Candidate& rival = best[node % moments_];
    if (explained <= rival.explained) continue;
    const TouchState touch = stateAt(node, coordinates);
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

double TouchSearch::unexplainedShare(const VectorXd& strains, std::optional<int> leftOut) const {
  VectorXd seen = strains;
  if (leftOut) seen[*leftOut] = 0;
  const VectorXd along = orthonormal_.transpose() * seen;
  double best = 0;
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    const Index first = 2 * static_cast<Index>(node);
    const Eigen::Vector2d projected = along.segment<2>(first);
    Eigen::Vector2d coordinates = projected;
    if (leftOut) coordinates = withoutGauge(orthonormal_.block<1, 2>(*leftOut, first), projected);
    const double explained = projected.dot(coordinates);
    if (explained > best && isAdmissible(stateAt(node, coordinates), {})) best = explained;
  }
  return 1 - best / seen.squaredNorm();
}

TouchFit TouchSearch::find(const RingResponse& ring, const TouchData& data) const {
  return refineTouches(ring, data, starts(data.readings - ring.zeros(), data.prior));
}

TouchSearch drawnSearch(const config::FingerConfig& config) {
  const Drawing drawing(config);
  const RingResponse drawn(drawing, VectorXd::Zero(drawing.unknowns()), RingResponse::lastHarmonic(drawing));
  return {drawn, config};
}

}  // namespace strainfinger::calibration
