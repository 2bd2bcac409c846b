#include "host/contact/thin_svd.hpp"

#include <Eigen/SVD>

namespace strainfinger::contact {

ThinSvd thinSvd(const Eigen::MatrixXd& matrix) {
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  return {svd.matrixU(), svd.singularValues(), svd.matrixV()};
}

}  // namespace strainfinger::contact
