#include "diagnosis/families/widths.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace flexcomp::diagnosis {
namespace {

constexpr int kLearningRounds =
    40;  // they approach the most likely widths slowly, and need no digit
constexpr double kNarrowest = 1e-2;  // times the usual

/// Second moments of the numbers, given what was measured.
Eigen::VectorXd second_moments(const NormalEquations& equations, const Eigen::VectorXd& width) {
  Eigen::MatrixXd inner = equations.gram / equations.variance;
  inner.diagonal() += width.cwiseAbs2().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> factors(inner);
  const Eigen::VectorXd mean = factors.solve(equations.moment / equations.variance);
  const Eigen::MatrixXd covariance =
      factors.solve(Eigen::MatrixXd::Identity(inner.rows(), inner.cols()));
  return mean.cwiseAbs2() + covariance.diagonal();
}

}  // namespace

Eigen::VectorXd learn_widths(const NormalEquations& equations, const Eigen::VectorXd& usual,
                             const std::vector<std::size_t>& kind) {
  Eigen::VectorXd width = usual;
  const std::size_t kinds = kind.empty() ? 0 : *std::max_element(kind.begin(), kind.end()) + 1;
  for (int round = 0; round < kLearningRounds; ++round) {
    const Eigen::VectorXd square =
        second_moments(equations, width).cwiseQuotient(usual.cwiseAbs2());
    std::vector<double> sum(kinds, 0);
    std::vector<double> count(kinds, 0);
    for (std::size_t i = 0; i < kind.size(); ++i) {
      sum[kind[i]] += square[static_cast<Eigen::Index>(i)];
      count[kind[i]] += 1;
    }
    for (std::size_t i = 0; i < kind.size(); ++i) {
      const double scale = std::sqrt(sum[kind[i]] / count[kind[i]]);
      const auto at = static_cast<Eigen::Index>(i);
      width[at] = usual[at] * std::clamp(scale, kNarrowest, 1.0);
    }
  }
  return width;
}

}  // namespace flexcomp::diagnosis
