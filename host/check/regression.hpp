#pragma once

#include <Eigen/Core>

namespace flexcomp::check {

/// Least squares of a target by columns, and how surely each column is in it.
struct Regression {
  Eigen::VectorXd value;  ///< coefficient of each column
  /// Standard deviation of each; rows that hang together count as fewer (noise::effective_samples).
  Eigen::VectorXd deviation;
  /// Partial correlation of each column with the target, beside all others: −1 to 1.
  Eigen::VectorXd partial;
  double left = 0;  ///< root mean square of what stays

  /// Is a coefficient beyond chance, and does its column account for a good part of what the others
  /// leave?
  bool is_told(Eigen::Index column, double least_partial) const;
};

/// Robust (Huber weights): single rows that are far off hardly count. Columns that are nearly
/// combinations of others get coefficients near zero. Rows follow in time.
Regression regress(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target);

}  // namespace flexcomp::check
