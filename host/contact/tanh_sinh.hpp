#pragma once
// Quadrature that minds neither a root nor a logarithm at the ends of its interval.

#include <Eigen/Core>

namespace strainfinger::contact {

/// Nodes in (0, 1), as distances to either end (the smaller one has all its digits), with their weights
/// (Takahasi & Mori 1974, double exponential).
struct TanhSinhRule {
  Eigen::ArrayXd fromStart;
  Eigen::ArrayXd fromEnd;
  Eigen::ArrayXd weights;

  /// `density` nodes per unit of the transformed variable, about 8 times as many in all. 16 integrate
  /// x^a (1-x)^b ln x times a polynomial of degree 20, a and b >= -1/2, to 1e-14.
  explicit TanhSinhRule(int density);

  /// Dense enough between edges of patches and singularities of the kernel, to 1e-14, for polynomials of a
  /// degree besides.
  static TanhSinhRule ofDegree(int degree);
};

}  // namespace strainfinger::contact
