#include "host/contact/reference_patch.hpp"

#include <cmath>
#include <numbers>

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

constexpr int kSpareNodes = 16;  // for the kernel's factors besides the basis

VectorXd chebyshevPoints(int count) {
  VectorXd points(count);
  for (int i = 0; i < count; ++i) points[i] = std::cos(pi * (2 * i + 1) / (2.0 * count));
  return points;
}

}  // namespace

ReferencePatch::ReferencePatch(EdgeExponents exponents, int terms, int points, bool withSign)
    : exponents_(exponents),
      rules_{chebyshevPoints(points), gaussRule(exponents, terms + kSpareNodes), {}, {}, 0, {}} {
  const int nodes = terms + kSpareNodes;
  const VectorXd &places = rules_.rule.nodes, &weights = rules_.rule.weights;
  const MatrixXd values = jacobiValues(exponents, nodes, places);
  rules_.basis = values.leftCols(terms);
  rules_.logWeights =
      logarithmicMoments(exponents, nodes, rules_.points) * values.transpose() * weights.asDiagonal();
  if (exponents.right != exponents.left) rules_.signInLog = pi / 2 / std::tan(pi * exponents.right);
  if (!withSign) return;
  const QuadratureRule fromRight = gaussRule({exponents.right, 0}, nodes);
  const QuadratureRule fromLeft = gaussRule({0, exponents.left}, nodes);
  for (const double x : rules_.points) rules_.signRules.push_back(signRule(x, fromRight, fromLeft));
}

ReferencePatch ReferencePatch::atNodesOf(const ReferencePatch& other) const {
  ReferencePatch result = *this;
  result.rules_.rule = other.rules_.rule;
  result.rules_.logWeights = other.rules_.logWeights;
  const VectorXd& nodes = other.rules_.rule.nodes;
  result.rules_.basis =
      (1 - nodes.array().square()).matrix().asDiagonal() * jacobiValues(exponents_, terms(), nodes);
  return result;
}

// The integral over all of the patch, less twice that over the shorter side: there the weight of the far edge
// is analytic.
PatchRules::SignRule ReferencePatch::signRule(double x, const QuadratureRule& fromRight,
                                              const QuadratureRule& fromLeft) const {
  const bool isRight = x >= 0;
  const QuadratureRule& side = isRight ? fromRight : fromLeft;
  const double sign = isRight ? 1 : -1, half = (1 - std::abs(x)) / 2;
  const double near = isRight ? exponents_.right : exponents_.left,
               far = isRight ? exponents_.left : exponents_.right;
  const Index all = rules_.rule.nodes.size(), few = side.nodes.size();
  PatchRules::SignRule result{{VectorXd(all + few), VectorXd(all + few)}, {}};
  const ArrayXd places = x + half * (side.nodes.array() + sign);
  result.rule.nodes << rules_.rule.nodes, places.matrix();
  result.rule.weights << sign * rules_.rule.weights,
      (-2 * sign * std::pow(half, near + 1) * side.weights.array() * (1 + sign * places).pow(far)).matrix();
  result.basis = jacobiValues(exponents_, terms(), result.rule.nodes);
  return result;
}

}  // namespace strainfinger::contact
