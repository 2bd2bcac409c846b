#pragma once
// Polynomials orthogonal to the weights that tractions have at the edges of a contact, their quadrature, and
// their integrals against the logarithm.

#include <Eigen/Core>

namespace strainfinger::contact {

/// The weight (1 - x)^right (1 + x)^left on -1..1.
struct EdgeExponents {
  double right = 0.5;
  double left = 0.5;
};

/// A square root at both edges: what a smooth indenter's pressure falls with.
inline constexpr EdgeExponents kSmoothEdges{0.5, 0.5};

/// An inverse square root at both edges: what the shear of a contact that sticks rises with.
inline constexpr EdgeExponents kStuckEdges{-0.5, -0.5};

/// Values of the polynomials 0..count-1 that are orthonormal for the weight: one row a point. Domain:
/// exponents above -1. Error: some 1e-15 times the degree.
Eigen::MatrixXd jacobiValues(EdgeExponents exponents, int count, const Eigen::VectorXd& points);

struct QuadratureRule {
  Eigen::VectorXd nodes;
  Eigen::VectorXd weights;
};

/// The integral over -1..1 of weight * f, exact for f of a degree up to 2 count - 1 (Golub & Welsch 1969).
QuadratureRule gaussRule(EdgeExponents exponents, int count);

/// Of every polynomial of jacobiValues() and every point x in -1..1 (one row each) the integral over y of
///     weight(y) polynomial(y) [ln|x - y| + (pi/2) cot(pi right) sgn(x - y)],
/// a polynomial in x. Domain: right + left = 1, both in (0, 1), or kStuckEdges. Source: Tricomi's
/// (1/pi) PV int w P_n^(a,b) / (t - x) dt = cot(pi a) w P_n^(a,b) - (2 / sin pi a) P_(n+1)^(-a,-b) for
/// a + b = 1, integrated; int T_n ln|x - y| / sqrt(1 - y^2) dy = -pi T_n / n, -pi ln 2 at n = 0.
Eigen::MatrixXd logarithmicMoments(EdgeExponents exponents, int count, const Eigen::VectorXd& points);

}  // namespace strainfinger::contact
