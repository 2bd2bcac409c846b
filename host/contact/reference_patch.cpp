#include "host/contact/reference_patch.hpp"

#include <cmath>
#include <numbers>

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
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
      points_(chebyshevPoints(points)),
      rule_(gaussRule(exponents, terms + kSpareNodes)),
      basis_(jacobiValues(exponents, terms, rule_.nodes)),
      signInLog_(pi / 2 * std::cos(pi * exponents.right) / std::sin(pi * exponents.right)) {
  const int nodes = terms + kSpareNodes;
  if (exponents.right == exponents.left) signInLog_ = 0;
  logWeights_ = logarithmicMoments(exponents, nodes, points_) *
                jacobiValues(exponents, nodes, rule_.nodes).transpose() * rule_.weights.asDiagonal();
  if (!withSign) return;
  const QuadratureRule fromRight = gaussRule({exponents.right, 0}, nodes);
  const QuadratureRule fromLeft = gaussRule({0, exponents.left}, nodes);
  for (const double x : points_) signRules_.push_back(signRule(x, fromRight, fromLeft));
}

// The integral over all of the patch, less twice that over the shorter side: there the weight of the far edge
// is analytic.
ReferencePatch::SignRule ReferencePatch::signRule(double x, const QuadratureRule& fromRight,
                                                  const QuadratureRule& fromLeft) const {
  const bool isRight = x >= 0;
  const QuadratureRule& side = isRight ? fromRight : fromLeft;
  const double sign = isRight ? 1 : -1, half = (1 - std::abs(x)) / 2;
  const double near = isRight ? exponents_.right : exponents_.left,
               far = isRight ? exponents_.left : exponents_.right;
  const Index all = rule_.nodes.size(), few = side.nodes.size();
  SignRule result{{VectorXd(all + few), VectorXd(all + few)}, {}};
  const ArrayXd places = x + half * (side.nodes.array() + sign);
  result.rule.nodes << rule_.nodes, places.matrix();
  result.rule.weights << sign * rule_.weights,
      (-2 * sign * std::pow(half, near + 1) * side.weights.array() * (1 + sign * places).pow(far)).matrix();
  result.basis = jacobiValues(exponents_, terms(), result.rule.nodes);
  return result;
}

}  // namespace strainfinger::contact
