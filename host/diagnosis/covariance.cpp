#include "diagnosis/covariance.hpp"

#include <Eigen/QR>
#include <cmath>

namespace flexcomp::diagnosis {
namespace {

/// Sums of the samples' scores (derivative times weighted remainder) over stretches of time, a row
/// each.
Eigen::MatrixXd scores_of_stretches(const Observations& observations,
                                    const Eigen::MatrixXd& derivative,
                                    const Eigen::VectorXd& weighted_remainder) {
  Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(
      kHoldoutStretches * static_cast<Eigen::Index>(observations.scenes.size()), derivative.cols());
  for (Eigen::Index i = 0; i < weighted_remainder.size(); ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    const Eigen::Index stretch = stretch_of(at.row, observations.scenes[at.scene].rows());
    scores.row(static_cast<Eigen::Index>(at.scene) * kHoldoutStretches + stretch) +=
        weighted_remainder[i] * derivative.row(i);
  }
  return scores;
}

}  // namespace

Eigen::MatrixXd covariance_of(const Observations& observations, const Eigen::MatrixXd& derivative,
                              const Eigen::VectorXd& weight, const Eigen::VectorXd& remainder,
                              const Eigen::VectorXd& precision, double variance) {
  const Eigen::VectorXd size = derivative.colwise().norm();
  Eigen::MatrixXd gram = derivative.transpose() * (weight.asDiagonal() * derivative);
  gram.diagonal() += precision;
  const Eigen::VectorXd inverse = gram.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  gram = inverse.asDiagonal() * gram * inverse.asDiagonal();
  const Eigen::MatrixXd inner = gram.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::MatrixXd scores =
      scores_of_stretches(observations, derivative, weight.cwiseProduct(remainder)) *
      inverse.asDiagonal();
  const double stretches =
      static_cast<double>((scores.rowwise().squaredNorm().array() > 0).count());
  const Eigen::VectorXd together =
      (scores * inner).colwise().squaredNorm() * stretches / std::max(stretches - 1, 1.0);
  Eigen::VectorXd widening = inverse;
  for (Eigen::Index i = 0; i < widening.size(); ++i) {
    const double alone = inner(i, i) * variance;
    widening[i] *= !(size[i] > 0) ? 0 : std::sqrt(std::max(1.0, together[i] / alone));
  }
  return widening.asDiagonal() * (inner * variance) * widening.asDiagonal();
}

}  // namespace flexcomp::diagnosis
