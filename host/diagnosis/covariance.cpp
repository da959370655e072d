#include "diagnosis/covariance.hpp"

#include <Eigen/QR>
#include <algorithm>
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

bool is_same_series(const Observations& observations, Eigen::Index a, Eigen::Index b) {
  const Sample& one = observations.samples[static_cast<std::size_t>(a)];
  const Sample& other = observations.samples[static_cast<std::size_t>(b)];
  return one.scene == other.scene && one.channel == other.channel &&
         one.component == other.component;
}

}  // namespace

NormalInverse inverse_of(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight,
                         const Eigen::VectorXd& precision) {
  Eigen::MatrixXd gram = derivative.transpose() * (weight.asDiagonal() * derivative);
  gram.diagonal() += precision;
  const Eigen::VectorXd unit = gram.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  gram = unit.asDiagonal() * gram * unit.asDiagonal();
  return {unit, gram.completeOrthogonalDecomposition().pseudoInverse()};
}

double told_parameters(const NormalInverse& inverse, const Eigen::VectorXd& precision) {
  const Eigen::ArrayXd share = (precision.array() > 0)
                                   .select(inverse.inner.diagonal().array() *
                                               inverse.unit.array().square() * precision.array(),
                                           0);
  return static_cast<double>(precision.size()) - share.sum();
}

double correlated_widening(const Observations& observations, const Eigen::VectorXd& score) {
  constexpr Eigen::Index kLagPart = 40;  // of a series, over which a score may be correlated
  double alone = 0;
  double together = 0;
  Eigen::Index begin = 0;
  while (begin < score.size()) {
    Eigen::Index end = begin + 1;
    while (end < score.size() && is_same_series(observations, begin, end)) {
      ++end;
    }
    const auto series = score.segment(begin, end - begin);
    const Eigen::Index lags =
        observations.is_static ? 0 : std::max<Eigen::Index>(1, series.size() / kLagPart);
    alone += series.squaredNorm();
    together += series.squaredNorm();
    for (Eigen::Index lag = 1; lag <= lags && lag < series.size(); ++lag) {
      const double share = 1 - static_cast<double>(lag) / static_cast<double>(lags + 1);
      const Eigen::Index pairs = series.size() - lag;
      together += 2 * share * series.head(pairs).dot(series.tail(pairs));
    }
    begin = end;
  }
  return alone > 0 ? std::max(1.0, together / alone) : 1.0;
}

Eigen::MatrixXd covariance_of(const Observations& observations, const NormalInverse& inverse,
                              const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight,
                              const Eigen::VectorXd& remainder, double variance) {
  const Eigen::VectorXd size = derivative.colwise().norm();
  const auto& [unit, inner] = inverse;
  const Eigen::MatrixXd scores =
      scores_of_stretches(observations, derivative, weight.cwiseProduct(remainder)) *
      unit.asDiagonal();
  const double stretches =
      static_cast<double>((scores.rowwise().squaredNorm().array() > 0).count());
  const Eigen::VectorXd together =
      (scores * inner).colwise().squaredNorm() * stretches / std::max(stretches - 1, 1.0);
  Eigen::VectorXd widening = unit;
  for (Eigen::Index i = 0; i < widening.size(); ++i) {
    const double alone = inner(i, i) * variance;
    widening[i] *= !(size[i] > 0) ? 0 : std::sqrt(std::max(1.0, together[i] / alone));
  }
  return widening.asDiagonal() * (inner * variance) * widening.asDiagonal();
}

}  // namespace flexcomp::diagnosis
