#include "host/contact/jacobi.hpp"

#include <cmath>
#include <numbers>

#include "host/contact/tanh_sinh.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::contact;
using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST_GROUP(Jacobi) {
  static constexpr EdgeExponents kUneven{0.58, 0.42};

  /// int weight polynomial [ln|x - y| + (pi/2) cot(pi right) sgn(x - y)] dy by the double exponential rule.
  static ArrayXd momentsByQuadrature(EdgeExponents exponents, int count, double x) {
    const TanhSinhRule rule(20);
    const double signInLog = exponents.right == exponents.left
                                 ? 0
                                 : std::numbers::pi / 2 / std::tan(std::numbers::pi * exponents.right);
    ArrayXd sum = ArrayXd::Zero(count);
    for (const double side : {-1.0, 1.0}) {
      const double length = 1 + side * -x;  // from x to the edge
      const ArrayXd distance = length * rule.fromStart, near = length * rule.fromEnd, far = 2 - near;
      const ArrayXd weight =
          (side > 0 ? near : far).pow(exponents.right) * (side > 0 ? far : near).pow(exponents.left);
      const ArrayXd kernel = distance.log() - side * signInLog;
      const MatrixXd values = jacobiValues(exponents, count, (x + side * distance).matrix());
      sum += (values.transpose() * (length * rule.weights * weight * kernel).matrix()).array();
    }
    return sum;
  }
};

TEST(Jacobi, PolynomialsAreOrthonormal) {
  for (const EdgeExponents exponents : {kSmoothEdges, kStuckEdges, kUneven, EdgeExponents{0, 0.5}}) {
    const QuadratureRule rule = gaussRule(exponents, 40);
    const MatrixXd values = jacobiValues(exponents, 40, rule.nodes);
    const MatrixXd product = values.transpose() * rule.weights.asDiagonal() * values;
    DOUBLES_EQUAL(0, (product - MatrixXd::Identity(40, 40)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

// int sqrt(1 - x^2) x^8 = 5 pi / 256 * 7 / 10, int x^8 / sqrt(1 - x^2) = 35 pi / 128.
TEST(Jacobi, GaussRulesIntegratePowers) {
  const QuadratureRule smooth = gaussRule(kSmoothEdges, 5), stuck = gaussRule(kStuckEdges, 5);
  DOUBLES_EQUAL(7 * std::numbers::pi / 256, smooth.weights.dot(smooth.nodes.array().pow(8).matrix()), 1e-15);
  DOUBLES_EQUAL(35 * std::numbers::pi / 128, stuck.weights.dot(stuck.nodes.array().pow(8).matrix()), 1e-14);
}

// Of degrees 0 and 3 at x = 0.3 for (1 - x)^0.58 (1 + x)^0.42, by 30-digit quadrature (mpmath).
TEST(Jacobi, MomentsAgreeWithHighPrecision) {
  const MatrixXd moments = logarithmicMoments(kUneven, 4, VectorXd::Constant(1, 0.3));
  DOUBLES_EQUAL(-1.54398032067041, moments(0, 0), 1e-14);
  DOUBLES_EQUAL(0.536784931895819, moments(0, 3), 1e-14);
}

TEST(Jacobi, MomentsAgreeWithQuadrature) {
  for (const EdgeExponents exponents : {kSmoothEdges, kStuckEdges, kUneven, EdgeExponents{0.3, 0.7}})
    for (const double x : {-0.99, -0.4, 0.0, 0.7}) {
      const MatrixXd moments = logarithmicMoments(exponents, 20, VectorXd::Constant(1, x));
      const ArrayXd known = momentsByQuadrature(exponents, 20, x);
      DOUBLES_EQUAL(0, (moments.row(0).transpose().array() - known).abs().maxCoeff(), 1e-12);
    }
}
