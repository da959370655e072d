#include "diagnosis/covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/clusters.hpp"
#include "linear_algebra/gram.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kRidge = 1e-9;  // of a parameter's precision: keeps the rest solvable

/// Variance of each parameter (in the inverse's units) by the scatter of the fits that leave out
/// one cluster each. One that a cluster alone tells scatters
/// without bounds.
Eigen::VectorXd scatter_without_each(const Clusters& clusters, const NormalInverse& inverse,
                                     const Eigen::MatrixXd& derivative,
                                     const Eigen::VectorXd& weight,
                                     const Eigen::VectorXd& remainder) {
  std::vector<std::vector<Eigen::Index>> members(static_cast<std::size_t>(clusters.count));
  for (std::size_t i = 0; i < clusters.of.size(); ++i) {
    members[static_cast<std::size_t>(clusters.of[i])].push_back(static_cast<Eigen::Index>(i));
  }
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(derivative.cols());
  double used = 0;
  for (const std::vector<Eigen::Index>& own : members) {
    if (own.empty()) {
      continue;
    }
    const Eigen::MatrixXd slope = weight(own).cwiseSqrt().asDiagonal() *
                                  derivative(own, Eigen::all) * inverse.unit.asDiagonal();
    const Eigen::VectorXd score =
        slope.transpose() * weight(own).cwiseSqrt().cwiseProduct(remainder(own));
    Eigen::MatrixXd rest = inverse.gram - linear_algebra::gram_of(slope);
    rest.diagonal().array() += kRidge;
    squares += rest.ldlt().solve(score).cwiseAbs2();
    used += 1;
  }
  return squares * (used - 1) / std::max(used, 1.0);
}

bool is_same_series(const Observations& observations, Eigen::Index a, Eigen::Index b) {
  const Sample& one = observations.samples[static_cast<std::size_t>(a)];
  const Sample& other = observations.samples[static_cast<std::size_t>(b)];
  return one.scene == other.scene && one.channel == other.channel &&
         one.component == other.component;
}

/// Sum of the squares of the sums over all windows of a length that touch the series: Bartlett's
/// weights of its products, times the length, without a loop over the lags.
double squares_of_windows(const Eigen::Ref<const Eigen::VectorXd>& series, Eigen::Index length) {
  double squares = 0;
  double window = 0;
  for (Eigen::Index last = 0; last < series.size() + length - 1; ++last) {
    window += last < series.size() ? series[last] : 0;
    window -= last >= length ? series[last - length] : 0;
    squares += window * window;
  }
  return squares;
}

/// Covariance by errors (samples × independent causes, over the noise) of one deviation each.
Eigen::MatrixXd covariance_by(const Eigen::MatrixXd& errors, const NormalInverse& inverse,
                              const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight) {
  const Eigen::MatrixXd shift =
      inverse.unit.asDiagonal() *
      (inverse.inner *
       (inverse.unit.asDiagonal() * (derivative.transpose() * (weight.asDiagonal() * errors))));
  return shift * shift.transpose();
}

}  // namespace

NormalInverse inverse_of(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight,
                         const Eigen::VectorXd& precision) {
  Eigen::MatrixXd gram = linear_algebra::gram_of(weight.cwiseSqrt().asDiagonal() * derivative);
  gram.diagonal() += precision;
  const Eigen::VectorXd unit = gram.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
  gram = unit.asDiagonal() * gram * unit.asDiagonal();
  return {unit, gram, gram.completeOrthogonalDecomposition().pseudoInverse()};
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
    together += squares_of_windows(series, lags + 1) / static_cast<double>(lags + 1);
    begin = end;
  }
  return alone > 0 ? std::max(1.0, together / alone) : 1.0;
}

Eigen::MatrixXd covariance_of(const Observations& observations, const NormalInverse& inverse,
                              const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight,
                              const Eigen::VectorXd& remainder, double variance) {
  const Eigen::VectorXd size = derivative.colwise().norm();
  Eigen::VectorXd together = Eigen::VectorXd::Zero(derivative.cols());
  for (const Clusters& clusters : clusters_of_errors(observations)) {
    together =
        together.cwiseMax(scatter_without_each(clusters, inverse, derivative, weight, remainder));
  }
  Eigen::VectorXd widening = inverse.unit;
  for (Eigen::Index i = 0; i < widening.size(); ++i) {
    const double alone = inverse.inner(i, i) * variance;
    widening[i] *= !(size[i] > 0) ? 0 : std::sqrt(std::max(1.0, together[i] / alone));
  }
  return widening.asDiagonal() * (inverse.inner * variance) * widening.asDiagonal() +
         covariance_by(observations.acceleration_error(), inverse, derivative, weight);
}

}  // namespace flexcomp::diagnosis
