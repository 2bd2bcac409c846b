#pragma once
// Singular values of a matrix: one place that compiles Eigen's, which takes longer than all that uses them.

#include <Eigen/Core>

namespace strainfinger::contact {

/// matrix = left * values.asDiagonal() * right^T, the values falling; left and right with orthonormal
/// columns, as many as the smaller side of the matrix has.
struct ThinSvd {
  Eigen::MatrixXd left;
  Eigen::VectorXd values;
  Eigen::MatrixXd right;
};

/// Divide and conquer; Jacobi's, which keeps small values' digits, for 16 columns and less (Eigen::BDCSVD).
ThinSvd thinSvd(const Eigen::MatrixXd& matrix);

}  // namespace strainfinger::contact
