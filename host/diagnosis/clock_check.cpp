#include "diagnosis/clock_check.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/clusters.hpp"
#include "linear_algebra/gram.hpp"

namespace flexcomp::diagnosis {
namespace {

/// Derivatives of the prediction by the delay of each group, samples × groups.
Eigen::MatrixXd delay_columns(const Observations& observations,
                              const std::vector<Hypothesis>& hypotheses, const Fit& known,
                              std::vector<std::string>* groups) {
  constexpr double kStep = 1e-3;  // s: an arm's motion is straight over it
  const Changes changes(observations, known.machine);
  std::vector<Eigen::VectorXd> columns;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (!hypothesis.traits().is_clock) {
      continue;
    }
    groups->push_back(hypothesis.law->form);
    // Both ways: a sample that is shifted one way has less of its own noise, as if it were late.
    columns.emplace_back((changes.by(hypothesis, {kStep}) - changes.by(hypothesis, {-kStep})) /
                         (2 * kStep));
  }
  Eigen::MatrixXd all(observations.size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    all.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return all;
}

/// Variance of a number that is the sum of influence times error, with errors that hang together
/// within a cluster (Liang and Zeger 1986), over time or at a posture.
double clustered_variance(const std::array<Clusters, 2>& both, const Eigen::VectorXd& influence,
                          const Eigen::VectorXd& error) {
  double most = 0;
  for (const Clusters& clusters : both) {
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(clusters.count);
    for (Eigen::Index i = 0; i < influence.size(); ++i) {
      sums[clusters.of[static_cast<std::size_t>(i)]] += influence[i] * error[i];
    }
    const auto count = static_cast<double>(clusters.count);
    most = std::max(most, sums.squaredNorm() * count / std::max(count - 1, 1.0));
  }
  return most;
}

}  // namespace

std::vector<ClockCheck> check_clocks(const Observations& observations,
                                     const std::vector<Hypothesis>& hypotheses,
                                     const Dictionary& dictionary, const Fit& known) {
  std::vector<ClockCheck> checks;
  if (observations.is_static) {
    return checks;
  }
  std::vector<std::string> groups;
  const Eigen::MatrixXd late = delay_columns(observations, hypotheses, known, &groups);
  std::vector<Eigen::Index> others;
  for (const Entry& entry : dictionary.entries) {
    const Hypothesis& hypothesis = hypotheses[entry.hypothesis];
    if (hypothesis.traits().is_clock || !hypothesis.starts.front().empty()) {
      continue;
    }
    for (Eigen::Index i = 0; i < entry.count; ++i) {
      others.push_back(entry.first + i);
    }
  }
  // The smaller system of normal equations, in columns of unit length.
  const Eigen::Index n = observations.train;
  const auto count = static_cast<Eigen::Index>(others.size());
  const Eigen::Index all = count + late.cols();
  Eigen::MatrixXd columns(n, all);
  Eigen::VectorXd length(all);
  for (Eigen::Index i = 0; i < all; ++i) {
    columns.col(i) = i < count ? dictionary.columns.col(others[static_cast<std::size_t>(i)]).head(n)
                               : late.col(i - count).head(n);
    length[i] = std::max(columns.col(i).norm(), 1e-300);
    columns.col(i) /= length[i];
  }
  Eigen::MatrixXd gram = linear_algebra::gram_of(columns);
  gram.diagonal().array() += 1e-9;
  const Eigen::MatrixXd inverse = gram.ldlt().solve(Eigen::MatrixXd::Identity(all, all));
  const Eigen::VectorXd target = known.remainder.head(n);
  const Eigen::VectorXd solved = inverse * (columns.transpose() * target);
  const Eigen::VectorXd left = target - columns * solved;
  const double variance = left.squaredNorm() / static_cast<double>(n);
  const std::array<Clusters, 2> clusters = clusters_of_errors(observations);
  for (Eigen::Index i = count; i < all; ++i) {
    const double deviation = std::sqrt(std::max(
        variance * inverse(i, i), clustered_variance(clusters, columns * inverse.col(i), left)));
    checks.push_back({groups[static_cast<std::size_t>(i - count)], solved[i] / length[i],
                      deviation / length[i]});
  }
  return checks;
}

}  // namespace flexcomp::diagnosis
