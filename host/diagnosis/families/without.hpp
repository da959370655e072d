#pragma once

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// A fit without one of its choices, to first order about it: what the others become, each held by
/// its tolerance, and what they leave. Quick; good where a choice is one of many small ones.
class Without {
 public:
  Without(const Observations& observations, const Fit& whole);

  Fit operator()(std::size_t index) const;

 private:
  const Observations& observations_;
  const Fit& whole_;
  Eigen::VectorXd value_, precision_;
  Eigen::MatrixXd gram_;    ///< parameters × parameters, weighted, with the tolerances
  Eigen::VectorXd moment_;  ///< of the remainder
};

}  // namespace flexcomp::diagnosis
