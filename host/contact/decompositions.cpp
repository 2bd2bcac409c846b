#include "host/contact/decompositions.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace strainfinger::contact {

using Eigen::MatrixXd;
using Eigen::VectorXd;

ThinSvd thinSvd(const MatrixXd& matrix) {
  const Eigen::BDCSVD<MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

VectorXd leastSquares(const MatrixXd& matrix, const VectorXd& right) {
  const ThinSvd svd = thinSvd(matrix);
  return svd.right * (svd.left.transpose() * right).cwiseQuotient(svd.values);
}

VectorXd luSolution(const MatrixXd& equations, const VectorXd& right) {
  return equations.partialPivLu().solve(right);
}

VectorXd symmetricEigenvalues(const MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

VectorXd tridiagonalEigenvalues(const VectorXd& diagonal, const VectorXd& beside) {
  Eigen::SelfAdjointEigenSolver<MatrixXd> solver;
  return solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace strainfinger::contact
