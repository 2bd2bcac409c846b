#pragma once
// Decompositions of dense matrices: one place that compiles Eigen's, which takes longer than all that uses
// them.

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

/// x with the least |matrix * x - right|, by thinSvd(): of independent columns.
Eigen::VectorXd leastSquares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// x of equations * x = right, by LU with partial pivoting (Eigen::PartialPivLU): of singular equations,
/// whatever comes of it.
Eigen::VectorXd luSolution(const Eigen::MatrixXd& equations, const Eigen::VectorXd& right);

/// Eigenvalues of a symmetric matrix, rising (Eigen::SelfAdjointEigenSolver).
Eigen::VectorXd symmetricEigenvalues(const Eigen::MatrixXd& matrix);
/// Those of a tridiagonal matrix: its diagonal, and the n - 1 numbers beside it.
Eigen::VectorXd tridiagonalEigenvalues(const Eigen::VectorXd& diagonal, const Eigen::VectorXd& beside);

}  // namespace strainfinger::contact
