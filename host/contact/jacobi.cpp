#include "host/contact/jacobi.hpp"

#include <boost/math/special_functions/digamma.hpp>
#include <cmath>
#include <numbers>

#include "host/contact/decompositions.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

double weightIntegral(EdgeExponents e) {
  return std::pow(2, e.right + e.left + 1) * std::beta(e.right + 1, e.left + 1);
}

/// x p_k = off[k] p_(k-1) + diagonal[k] p_k + off[k+1] p_(k+1) for orthonormal p.
struct Recurrence {
  VectorXd diagonal, off;

  Recurrence(EdgeExponents e, int count) : diagonal(count), off(VectorXd::Zero(count)) {
    const double a = e.right, b = e.left, sum = a + b;
    diagonal[0] = (b - a) / (sum + 2);
    if (count > 1) off[1] = std::sqrt(4 * (1 + a) * (1 + b) / ((2 + sum) * (2 + sum) * (3 + sum)));
    for (int k = 1; k < count; ++k) diagonal[k] = (b * b - a * a) / ((2 * k + sum) * (2 * k + sum + 2));
    for (int k = 2; k < count; ++k) {
      const double twice = 2 * k + sum;
      off[k] = std::sqrt(4 * k * (k + a) * (k + b) * (k + sum) / (twice * twice * (twice + 1) * (twice - 1)));
    }
  }
};

/// P_0..P_(count-1) of parameters (a, b) with a + b = -1, as they are usually normalised.
MatrixXd conjugateValues(double a, double b, int count, const VectorXd& x) {
  MatrixXd p(x.size(), count);
  p.col(0).setOnes();
  p.col(1) = x / 2 + VectorXd::Constant(x.size(), 0.5 + a);
  for (int n = 2; n < count; ++n) {
    const double lead = 2.0 * n * (n - 1) * (2 * n - 3);
    const double slope = (2.0 * n - 2) * (2 * n - 1) * (2 * n - 3),
                 constant = (2.0 * n - 2) * (a * a - b * b);
    const double back = 2 * (n + a - 1) * (n + b - 1) * (2 * n - 1);
    p.col(n) = (((slope * x).array() + constant) * p.col(n - 1).array() - back * p.col(n - 2).array()) / lead;
  }
  return p;
}

/// Antiderivatives of conjugateValues()'s polynomials 1..count.
MatrixXd conjugateIntegrals(double a, double b, int count, const VectorXd& x) {
  const MatrixXd p = conjugateValues(a, b, count + 2, x);
  MatrixXd integrals(x.size(), count);
  integrals.col(0) = x.cwiseProduct(x) / 4 + (0.5 + a) * x;
  for (int m = 2; m <= count; ++m)
    integrals.col(m - 1) = p.col(m + 1) / (2 * m + 1) + 2 * (a - b) / ((2 * m - 1) * (2 * m + 1)) * p.col(m) -
                           2 * (m + a) * (m + b) / ((m - 1.0) * (2 * m - 1) * (2 * m)) * p.col(m - 1);
  return integrals;
}

/// sqrt of int w P_n^2 for right + left = 1.
double norm(EdgeExponents e, int n) {
  const double logSquare =
      std::lgamma(n + e.right + 1) + std::lgamma(n + e.left + 1) - std::lgamma(n + 1) - std::lgamma(n + 2);
  return std::sqrt(4.0 / (2 * n + 2) * std::exp(logSquare));
}

/// The moment of the usually normalised P_n at x = 1.
double momentAtRightEdge(EdgeExponents e, int n) {
  using boost::math::digamma;
  if (n > 0)
    return -4.0 / n * std::exp(std::lgamma(e.right + 1) + std::lgamma(n + e.left + 1) - std::lgamma(n + 3));
  const double cotangent = std::cos(pi * e.right) / std::sin(pi * e.right);
  return weightIntegral(e) * (std::numbers::ln2 + digamma(e.right + 1) - digamma(3.0) + pi / 2 * cotangent);
}

MatrixXd stuckMoments(int count, const VectorXd& points) {
  MatrixXd moments = -pi * jacobiValues(kStuckEdges, count, points);
  moments.col(0) *= std::numbers::ln2;
  for (int n = 2; n < count; ++n) moments.col(n) /= n;
  return moments;
}

/// With a root or an inverse root at both edges: Chebyshev's, in closed form.
QuadratureRule chebyshevRule(bool isSmooth, int count) {
  const ArrayXd steps = ArrayXd::LinSpaced(count, count, 1);
  const ArrayXd angles =
      isSmooth ? ArrayXd(steps * (pi / (count + 1))) : ArrayXd((steps - 0.5) * (pi / count));
  if (isSmooth) return {angles.cos(), pi / (count + 1) * angles.sin().square()};
  return {angles.cos(), VectorXd::Constant(count, pi / count)};
}

}  // namespace

MatrixXd jacobiValues(EdgeExponents exponents, int count, const VectorXd& points) {
  const Recurrence recurrence(exponents, count + 1);
  MatrixXd p(points.size(), count);
  p.col(0).setConstant(1 / std::sqrt(weightIntegral(exponents)));
  for (int k = 0; k + 1 < count; ++k) {
    p.col(k + 1) = (points.array() - recurrence.diagonal[k]) * p.col(k).array();
    if (k > 0) p.col(k + 1) -= recurrence.off[k] * p.col(k - 1);
    p.col(k + 1) /= recurrence.off[k + 1];
  }
  return p;
}

QuadratureRule gaussRule(EdgeExponents exponents, int count) {
  const bool isSymmetric = exponents.right == exponents.left;
  if (isSymmetric && std::abs(exponents.right) == 0.5) return chebyshevRule(exponents.right > 0, count);
  const Recurrence recurrence(exponents, count);
  QuadratureRule rule{tridiagonalEigenvalues(recurrence.diagonal, recurrence.off.tail(count - 1)), {}};
  rule.weights = jacobiValues(exponents, count, rule.nodes).rowwise().squaredNorm().cwiseInverse();
  return rule;
}

MatrixXd logarithmicMoments(EdgeExponents exponents, int count, const VectorXd& points) {
  if (exponents.right < 0) return stuckMoments(count, points);
  const double a = -exponents.right, b = -exponents.left;
  MatrixXd moments = conjugateIntegrals(a, b, count, points);
  moments.rowwise() -= conjugateIntegrals(a, b, count, VectorXd::Ones(1)).row(0);
  moments *= 2 * pi / std::sin(pi * exponents.right);
  for (int n = 0; n < count; ++n) {
    moments.col(n).array() += momentAtRightEdge(exponents, n);
    moments.col(n) /= norm(exponents, n);
  }
  return moments;
}

}  // namespace strainfinger::contact
