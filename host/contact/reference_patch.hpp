#pragma once
// A patch's discretisation that is the same wherever the patch is and however wide.

#include <vector>

#include "host/contact/jacobi.hpp"

namespace strainfinger::contact {

/// How a density on a patch is integrated against what a kernel has at each of some points x_i of the same
/// patch. The density is known at nodes y_j, as functions (columns of `basis`) times a weight that is not.
struct PatchRules {
  Eigen::VectorXd points;  ///< x_i
  QuadratureRule rule;     ///< sum weights_j f(y_j) = int weight f
  Eigen::MatrixXd basis;   ///< function k at y_j
  Eigen::MatrixXd
      logWeights;  ///< sum (i, j) f(y_j) = int weight(y) f(y) [ln|x_i - y| + signInLog sgn(x_i - y)]
  double signInLog = 0;

  /// One side of a point: sum weights * f(y) = int weight(y) f(y) sgn(x_i - y) dy, the basis in rows like the
  /// nodes.
  struct SignRule {
    QuadratureRule rule;
    Eigen::MatrixXd basis;
  };
  std::vector<SignRule> signRules;  ///< one a point; none: no kernel with a sign is asked for
};

/// Those of weighted polynomials: weight * f, f a polynomial of the basis times an analytic factor of the
/// kernel.
class ReferencePatch {
 public:
  /// `terms` polynomials seen at `points` Chebyshev points. `withSign` prepares sgn(x_i - y) too.
  /// Costs 50 us for 16 terms.
  ReferencePatch(EdgeExponents exponents, int terms, int points, bool withSign);

  /// The same densities, known at the nodes of another patch's rule as functions times that one's weight.
  /// Domain: kSmoothEdges; the other one kStuckEdges, of terms and more.
  ReferencePatch atNodesOf(const ReferencePatch& other) const;

  EdgeExponents exponents() const { return exponents_; }
  int terms() const { return static_cast<int>(rules_.basis.cols()); }
  const Eigen::VectorXd& points() const { return rules_.points; }
  const PatchRules& rules() const { return rules_; }

 private:
  PatchRules::SignRule signRule(double x, const QuadratureRule& fromRight,
                                const QuadratureRule& fromLeft) const;

  EdgeExponents exponents_;
  PatchRules rules_;
};

}  // namespace strainfinger::contact
