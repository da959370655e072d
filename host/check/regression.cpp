#include "check/regression.hpp"

#include <algorithm>
#include <cmath>

#include "linear_algebra/decompositions.hpp"
#include "recording/noise.hpp"

namespace flexcomp::check {
namespace {

/// Ridge of normal equations in columns of unit length, so that a column that nearly is a
/// combination of others does no harm.
constexpr double kRidge = 1e-8;
constexpr double kHuber = 2.5;  // deviations
constexpr double kRounding = 1e-9;
constexpr int kRounds = 4;  // of Huber's weights

double correlation_of_neighbours(const Eigen::VectorXd& values) {
  const Eigen::Index n = values.size();
  const double power = values.squaredNorm();
  if (n < 3 || !(power > 0)) {
    return 0;
  }
  return std::clamp(values.head(n - 1).dot(values.tail(n - 1)) / power, 0.0, 0.999);
}

}  // namespace

bool Regression::is_told(Eigen::Index column, double least_partial) const {
  constexpr double kSure = 6;  // deviations: no chance among the few hundred that are looked at
  return std::abs(value[column]) > kSure * deviation[column] &&
         std::abs(partial[column]) > least_partial;
}

Regression regress(const Eigen::MatrixXd& columns, const Eigen::VectorXd& target) {
  const Eigen::Index n = columns.rows();
  const Eigen::Index m = columns.cols();
  // Columns that are nothing but rounding beside the target would get coefficients without end.
  const Eigen::VectorXd size = columns.colwise().norm().transpose();
  const Eigen::ArrayXd counts =
      (size.array() > kRounding * target.norm()).select(Eigen::ArrayXd::Ones(m), 0.0);
  const Eigen::VectorXd length = (counts > 0).select(size, 1.0);
  const Eigen::MatrixXd unit = columns * counts.cwiseQuotient(length.array()).matrix().asDiagonal();
  Eigen::VectorXd weight = Eigen::VectorXd::Ones(n);
  Eigen::VectorXd solved = Eigen::VectorXd::Zero(m);
  Eigen::VectorXd residual = target;
  Eigen::MatrixXd inverse;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::MatrixXd gram = unit.transpose() * weight.asDiagonal() * unit;
    gram.diagonal().array() += kRidge;
    inverse = gram.ldlt().solve(Eigen::MatrixXd::Identity(m, m));
    solved = inverse * (unit.transpose() * (weight.array() * target.array()).matrix());
    residual = target - unit * solved;
    const double limit = kHuber * recording::robust_deviation(residual);
    if (!(limit > 0)) {
      break;
    }
    weight = (residual.array().abs() > limit)
                 .select((limit / residual.array().abs().max(1e-300)).square(), 1.0)
                 .matrix();
  }
  const double power = (weight.array() * residual.array().square()).sum();
  const double rows = std::max(weight.sum(), 1.0);
  const double independent =
      std::max(recording::effective_samples(rows, correlation_of_neighbours(residual)), 1.0);
  const double variance = power / rows * rows / independent;
  Regression result;
  result.left = std::sqrt(power / rows);
  result.value = solved.cwiseQuotient(length);
  result.deviation = (variance * inverse.diagonal().array().max(0.0)).sqrt().matrix();
  result.deviation = result.deviation.cwiseQuotient(length);
  result.partial.resize(m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const double own = solved[i] / std::sqrt(std::max(inverse(i, i), 1e-300));
    result.partial[i] = own / std::sqrt(std::max(own * own + power, 1e-300));
  }
  return result;
}

}  // namespace flexcomp::check
