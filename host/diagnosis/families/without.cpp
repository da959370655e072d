#include "diagnosis/families/without.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace flexcomp::diagnosis {

Without::Without(const Observations& observations, const Fit& whole)
    : observations_(observations), whole_(whole) {
  const auto count = static_cast<Eigen::Index>(whole.parameters());
  value_.resize(count);
  precision_.resize(count);
  Eigen::Index at = 0;
  for (const Chosen& each : whole.chosen) {
    for (std::size_t i = 0; i < each.values.size(); ++i, ++at) {
      value_[at] = each.values[i];
      precision_[at] = std::pow(each.hypothesis.parameters[i].tolerance, -2);
    }
  }
  const Eigen::Index n = observations.train;
  const Eigen::VectorXd weight = huber_weights(whole.remainder.head(n));
  const auto columns = whole.derivative.topRows(n);
  gram_ = columns.transpose() * (weight.asDiagonal() * columns);
  gram_.diagonal() += precision_;
  moment_ = columns.transpose() * weight.cwiseProduct(whole.remainder.head(n));
}

Fit Without::operator()(std::size_t index) const {
  const Eigen::Index first = whole_.first_parameter(index);
  const auto width = static_cast<Eigen::Index>(whole_.chosen[index].values.size());
  std::vector<Eigen::Index> own;
  std::vector<Eigen::Index> others;
  for (Eigen::Index i = 0; i < value_.size(); ++i) {
    (i >= first && i < first + width ? own : others).push_back(i);
  }
  const Eigen::VectorXd lost = value_(own);
  Eigen::MatrixXd inner = gram_(others, others);
  inner.diagonal() += 1e-12 * inner.diagonal();
  const Eigen::VectorXd change =
      inner.ldlt().solve(moment_(others) + gram_(others, own) * lost -
                         precision_(others).cwiseProduct(value_(others)));
  Fit fit;
  fit.chosen = whole_.chosen;
  fit.chosen.erase(fit.chosen.begin() + static_cast<std::ptrdiff_t>(index));
  Eigen::Index at = 0;
  for (Chosen& each : fit.chosen) {
    for (double& value : each.values) {
      value += change[at++];
    }
  }
  fit.machine = machine_with(observations_, fit.chosen);
  fit.derivative = whole_.derivative(Eigen::all, others);
  fit.remainder =
      whole_.remainder + whole_.derivative(Eigen::all, own) * lost - fit.derivative * change;
  const Eigen::Index n = observations_.train;
  fit.train_sum = huber_weights(fit.remainder.head(n)).dot(fit.remainder.head(n).cwiseAbs2());
  return fit;
}

}  // namespace flexcomp::diagnosis
