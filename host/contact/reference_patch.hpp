#pragma once
// A patch's discretisation that is the same wherever the patch is and however wide.

#include <vector>

#include "host/contact/jacobi.hpp"

namespace strainfinger::contact {

/// For one weight: collocation points x_i, and the rules that integrate weight * f against what a kernel has
/// at each of them. f is a polynomial of the basis times an analytic factor of the kernel.
class ReferencePatch {
 public:
  /// `terms` polynomials seen at `points` Chebyshev points. `withSign` prepares sgn(x_i - y) too.
  /// Costs 50 us for 16 terms.
  ReferencePatch(EdgeExponents exponents, int terms, int points, bool withSign);

  EdgeExponents exponents() const { return exponents_; }
  int terms() const { return static_cast<int>(basis_.cols()); }
  const Eigen::VectorXd& points() const { return points_; }          ///< x_i
  const QuadratureRule& rule() const { return rule_; }               ///< nodes y_j, weights
  const Eigen::MatrixXd& basis() const { return basis_; }            ///< polynomial k at y_j
  const Eigen::MatrixXd& logWeights() const { return logWeights_; }  ///< (i, j): as logarithmicMoments()

  /// What logWeights() hold of sgn(x - y): (pi/2) cot(pi right).
  double signInLog() const { return signInLog_; }

  /// One side of a collocation point: sum weights * f(y) = int weight(y) f(y) sgn(x_i - y) dy, the basis in
  /// rows like the nodes.
  struct SignRule {
    QuadratureRule rule;
    Eigen::MatrixXd basis;
  };
  const std::vector<SignRule>& signRules() const { return signRules_; }  ///< one a point; none without sign

 private:
  SignRule signRule(double x, const QuadratureRule& fromRight, const QuadratureRule& fromLeft) const;

  EdgeExponents exponents_;
  Eigen::VectorXd points_;
  QuadratureRule rule_;
  Eigen::MatrixXd basis_;
  Eigen::MatrixXd logWeights_;
  double signInLog_;
  std::vector<SignRule> signRules_;
};

}  // namespace strainfinger::contact
