#include "host/contact/tractions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/contact/tanh_sinh.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

PatchPoints pointsAt(const Eigen::VectorXd& x) { return {1 + x.array(), 1 - x.array()}; }

/// Nodes that a Gauss rule needs for a series times cos n (centre + half x).
int nodesFor(const PatchTractions& part, int harmonics) {
  const auto degree =
      static_cast<int>(std::max(part.smooth.coefficients.size(), part.stuck.coefficients.size()));
  return degree + 24 + static_cast<int>(0.75 * harmonics * part.patch.half_rad);
}

/// Line tractions of values at nodes; the weight function is in the rule, not in the values.
void append(std::vector<LineTraction>& lines, const Patch& patch, const Eigen::VectorXd& x,
            const ArrayXd& pressure, const ArrayXd& shear) {
  for (Index i = 0; i < x.size(); ++i)
    lines.push_back(
        {patch.centre_rad + patch.half_rad * x[i], patch.half_rad * pressure[i], patch.half_rad * shear[i]});
}

void appendSeries(std::vector<LineTraction>& lines, const Patch& patch, const EdgeSeries& series, int nodes,
                  Traction share) {
  if (series.coefficients.size() == 0) return;
  const QuadratureRule rule = gaussRule(series.exponents, nodes);
  const ArrayXd loads =
      (jacobiValues(series.exponents, static_cast<int>(series.coefficients.size()), rule.nodes) *
       series.coefficients)
          .array() *
      rule.weights.array();
  append(lines, patch, rule.nodes, share.pressure_pa * loads, share.shear_pa * loads);
}

/// Gauss's nodes with weights that integrate arccosh times polynomials of lower degree than nodes.
ArrayXd tipLoads(const TipTraction& tip, const QuadratureRule& rule) {
  if (!tip.isThere()) return ArrayXd::Zero(rule.nodes.size());
  const auto count = static_cast<int>(rule.nodes.size());
  const Eigen::MatrixXd values = jacobiValues(kSmoothEdges, count, rule.nodes);
  const ArrayXd weights = rule.weights.array() * (values * tipMoments(tip.position, count)).array();
  return weights * (values.leftCols(tip.log.size()) * tip.log).array();
}

void appendSteplessTip(std::vector<LineTraction>& lines, const PatchTractions& part, int harmonics) {
  const auto degree = static_cast<int>(part.tip.log.size());
  const QuadratureRule rule =
      gaussRule(kSmoothEdges, degree + 24 + static_cast<int>(1.5 * harmonics * part.patch.half_rad));
  const ArrayXd pressures = tipLoads(part.tip, rule);
  append(lines, part.patch, rule.nodes, pressures, part.friction * pressures + tipLoads(part.stuckTip, rule));
}

/// Both sides of the tip.
void appendSteppedTip(std::vector<LineTraction>& lines, const PatchTractions& part, int harmonics) {
  const TanhSinhRule rule(16 + static_cast<int>(harmonics * part.patch.half_rad / 4));
  const double x0 = part.tip.position;
  for (const double end : {-1.0, 1.0}) {
    const ArrayXd x = x0 + (end - x0) * rule.fromStart;
    const auto loads = [&](const TipTraction& tip) -> ArrayXd {
      const ArrayXd values = tip.at({1 + x, 1 - x});  // infinite where rounding made x x0
      return std::abs(end - x0) * rule.weights * values.isFinite().select(values, 0);
    };
    const ArrayXd pressures = loads(part.tip);
    append(lines, part.patch, x.matrix(), pressures, part.friction * pressures + loads(part.stuckTip));
  }
}

}  // namespace

ArrayXd edgeWeight(EdgeExponents exponents, const PatchPoints& points) {
  const bool isSymmetric = exponents.right == exponents.left;
  if (isSymmetric && exponents.right == 0.5) return (points.fromRight * points.fromLeft).sqrt();
  if (isSymmetric && exponents.right == -0.5) return (points.fromRight * points.fromLeft).rsqrt();
  return points.fromRight.pow(exponents.right) * points.fromLeft.pow(exponents.left);
}

ArrayXd EdgeSeries::at(const PatchPoints& points) const {
  if (coefficients.size() == 0) return ArrayXd::Zero(points.fromLeft.size());
  const Eigen::VectorXd polynomial =
      jacobiValues(exponents, static_cast<int>(coefficients.size()), points.x().matrix()) * coefficients;
  return edgeWeight(exponents, points) * polynomial.array();
}

double EdgeSeries::integral() const {
  if (coefficients.size() == 0) return 0;
  return coefficients[0] / jacobiValues(exponents, 1, Eigen::VectorXd::Zero(1))(0, 0);
}

ArrayXd TipTraction::at(const PatchPoints& points) const {
  if (!isThere()) return ArrayXd::Zero(points.fromLeft.size());
  const Eigen::VectorXd x = points.x();
  const ArrayXd offset = x.array() - position;
  const ArrayXd root = (points.fromLeft * points.fromRight * ((1 - position) * (1 + position))).sqrt();
  const auto series = [&](const Eigen::VectorXd& c) -> ArrayXd {
    return jacobiValues(kSmoothEdges, static_cast<int>(c.size()), x) * c;
  };
  ArrayXd values = (root / offset.abs()).asinh() * series(log);
  if (step.size() > 0)
    values += offset.sign() * root.binaryExpr(offset.abs(), [](double up, double along) {
      return std::atan2(up, along);
    }) * series(step);
  return values;
}

double TipTraction::integral() const {
  if (!isThere()) return 0;
  double sum = log.dot(tipMoments(position, static_cast<int>(log.size())));
  const double angle = std::acos(position), ratio = position / (1 + std::sin(angle));
  for (Index k = 0; k < step.size(); ++k) {
    const auto n = static_cast<double>(k + 1);
    sum -= step[k] * std::sqrt(2 * std::numbers::pi) / n * (std::cos(n * angle) - std::pow(ratio, n));
  }
  return sum;
}

// With x = cos phi the function is 2 sum sin(n phi0) sin(n phi) / n.
Eigen::VectorXd tipMoments(double position, int count) {
  const ArrayXd n = ArrayXd::LinSpaced(count, 1, count);
  return std::sqrt(2 * std::numbers::pi) * (n * std::acos(position)).sin() / n;
}

ArrayXd PatchTractions::pressure_pa(const PatchPoints& points) const {
  return smooth.at(points) + tip.at(points);
}

ArrayXd PatchTractions::stuck_pa(const PatchPoints& points) const {
  return stuck.at(points) + stuckTip.at(points);
}

ArrayXd PatchTractions::shear_pa(const PatchPoints& points) const {
  if (friction == 0) return stuck_pa(points);
  return friction * pressure_pa(points) + stuck_pa(points);
}

Traction tractionAt(const Tractions& tractions, double angle_rad) {
  for (const PatchTractions& part : tractions) {
    const double x = (angle_rad - part.patch.centre_rad) / part.patch.half_rad;
    if (!(std::abs(x) <= 1)) continue;
    const PatchPoints point = pointsAt(Eigen::VectorXd::Constant(1, x));
    return {part.pressure_pa(point)[0], part.shear_pa(point)[0]};
  }
  return {};
}

std::vector<LineTraction> lineTractions(const Tractions& tractions, int harmonics) {
  std::vector<LineTraction> lines;
  for (const PatchTractions& part : tractions) {
    const int nodes = nodesFor(part, harmonics);
    appendSeries(lines, part.patch, part.smooth, nodes, {1, part.friction});
    appendSeries(lines, part.patch, part.stuck, nodes, {0, 1});
    if (part.tip.step.size() > 0)
      appendSteppedTip(lines, part, harmonics);
    else if (part.tip.isThere())
      appendSteplessTip(lines, part, harmonics);
  }
  return lines;
}

Traction totalTraction(const Tractions& tractions) {
  Traction total;
  for (const PatchTractions& part : tractions) {
    const double pressure = part.patch.half_rad * (part.smooth.integral() + part.tip.integral());
    total.pressure_pa += pressure;
    total.shear_pa +=
        part.friction * pressure + part.patch.half_rad * (part.stuck.integral() + part.stuckTip.integral());
  }
  return total;
}

}  // namespace strainfinger::contact
