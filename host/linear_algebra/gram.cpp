#include "linear_algebra/gram.hpp"

namespace flexcomp::linear_algebra {

Eigen::MatrixXd gram_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  Eigen::MatrixXd half = Eigen::MatrixXd::Zero(matrix.cols(), matrix.cols());
  half.selfadjointView<Eigen::Lower>().rankUpdate(matrix.transpose());
  return half.selfadjointView<Eigen::Lower>();
}

}  // namespace flexcomp::linear_algebra
