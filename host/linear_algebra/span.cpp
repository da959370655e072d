#include "linear_algebra/span.hpp"

#include <Eigen/QR>

namespace flexcomp::linear_algebra {

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) {
    return columns;
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(columns);
  return factors.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), factors.rank());
}

}  // namespace flexcomp::linear_algebra
