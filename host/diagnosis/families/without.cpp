#include "diagnosis/families/without.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
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
}

bool Without::multiplies_any(const Chosen& chosen, const std::vector<std::size_t>& indices) const {
  return chosen.hypothesis.traits().is_gain &&
         std::any_of(indices.begin(), indices.end(), [&](std::size_t index) {
           return whole_.chosen[index].hypothesis.joint == chosen.hypothesis.joint;
         });
}

Fit Without::operator()(const std::vector<std::size_t>& indices) const {
  std::vector<Eigen::Index> own;
  std::vector<Eigen::Index> others;
  std::vector<Eigen::Index> free;  // of the others, by their place among them
  Fit fit;
  Eigen::Index parameter = 0;
  for (std::size_t i = 0; i < whole_.chosen.size(); ++i) {
    const bool goes = std::binary_search(indices.begin(), indices.end(), i);
    if (!goes) {
      fit.chosen.push_back(whole_.chosen[i]);
    }
    const std::size_t linear = whole_.chosen[i].hypothesis.linear;
    for (std::size_t k = 0; k < whole_.chosen[i].values.size(); ++k, ++parameter) {
      if (!goes) {
        if (!multiplies_any(whole_.chosen[i], indices)) {
          free.push_back(static_cast<Eigen::Index>(others.size()));
        }
        others.push_back(parameter);
      } else if (linear == 0 || k < linear) {  // the rest only shapes what is nothing then
        own.push_back(parameter);
      }
    }
  }
  const Eigen::VectorXd lost = value_(own);
  Eigen::MatrixXd inner = gram_(others, others);
  inner.diagonal() += 1e-12 * inner.diagonal();
  const Eigen::LDLT<Eigen::MatrixXd> factors(inner);
  const Eigen::VectorXd pull = gram_(others, own) * lost;
  Eigen::VectorXd change = Eigen::VectorXd::Zero(inner.rows());
  const Eigen::VectorXd step =
      Eigen::MatrixXd(inner(free, free)).ldlt().solve(Eigen::VectorXd(pull(free)));
  change(free) = step;
  Eigen::Index at = 0;
  for (Chosen& each : fit.chosen) {
    for (double& value : each.values) {
      value += change[at++];
    }
  }
  const Eigen::VectorXd variance =
      factors.solve(Eigen::MatrixXd::Identity(inner.rows(), inner.cols())).diagonal();
  fit.told = static_cast<double>(others.size()) - variance.dot(precision_(others));
  fit.machine = machine_with(observations_, fit.chosen);
  fit.derivative = whole_.derivative(Eigen::all, others);
  fit.remainder =
      whole_.remainder + whole_.derivative(Eigen::all, own) * lost - fit.derivative * change;
  const Eigen::Index n = observations_.train;
  fit.train_sum = huber_weights(fit.remainder.head(n)).dot(fit.remainder.head(n).cwiseAbs2());
  return fit;
}

}  // namespace flexcomp::diagnosis
