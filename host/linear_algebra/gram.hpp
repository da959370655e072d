#pragma once

#include <Eigen/Core>

namespace flexcomp::linear_algebra {

/// A matrix's transpose times the matrix, at the cost of half of its elements.
Eigen::MatrixXd gram_of(const Eigen::Ref<const Eigen::MatrixXd>& matrix);

}  // namespace flexcomp::linear_algebra
