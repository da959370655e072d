#pragma once

#include <Eigen/Core>

namespace flexcomp::linear_algebra {

/// Orthonormal columns that span those of a matrix; none where it has none.
Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& columns);

}  // namespace flexcomp::linear_algebra
