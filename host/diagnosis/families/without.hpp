#pragma once

#include <vector>

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// A fit without some of its choices, to first order about it: what the others become, each held by
/// its tolerance, and what they leave. Quick; good where these are a few of many small ones. The
/// whole fit is taken to be at its optimum within what bodies can be: a plain step from it would
/// leave that, and compare unlike with like.
///
/// A gain stays as it is where something at its joint goes: its derivative holds what it
/// multiplies, and would put it back.
class Without {
 public:
  Without(const Observations& observations, const Fit& whole);

  /// `indices`: the choices that go, ascending.
  Fit operator()(const std::vector<std::size_t>& indices) const;

 private:
  bool multiplies_any(const Chosen& chosen, const std::vector<std::size_t>& indices) const;

  const Observations& observations_;
  const Fit& whole_;
  Eigen::VectorXd value_, precision_;
  Eigen::MatrixXd gram_;  ///< parameters × parameters, weighted, with the tolerances
};

}  // namespace flexcomp::diagnosis
