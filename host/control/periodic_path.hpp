#pragma once

#include <Eigen/Core>

namespace flexcomp::control {

/// A closed curve through evenly spaced samples with all its derivatives: a Fourier series of the
/// lower harmonics.
class PeriodicPath {
 public:
  /// Rows are the samples of one turn, the first not repeated at the end. Needs more than twice
  /// `harmonics` rows.
  explicit PeriodicPath(const Eigen::MatrixXd& samples, int harmonics = 24);

  struct Sample {
    Eigen::VectorXd value;
    Eigen::VectorXd slope;      ///< by turns
    Eigen::VectorXd curvature;  ///< by turns, twice
  };

  /// At so many turns from the first sample.
  Sample at(double turns) const;

 private:
  Eigen::MatrixXd cosine_;  ///< a column a harmonic, from 0 on
  Eigen::MatrixXd sine_;
};

}  // namespace flexcomp::control
