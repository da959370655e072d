#pragma once

#include "diagnosis/diagnosis.hpp"
#include "diagnosis/select/propose.hpp"

namespace flexcomp::diagnosis {

/// Error of the component that each sample is of (a joint's torque, a coordinate), over its noise;
/// at least one. `remainder`: of the samples to fit to at least, over the noise.
///
/// No model is right to the noise. Weighted by the noise alone, the component that is measured best
/// decides what its own model error makes of the numbers that all components share. Weighted by
/// what is left of each (feasible generalised least squares, as identification does it joint by
/// joint; Gautier 1997), none does.
Eigen::VectorXd model_error(const Observations& observations, const Eigen::VectorXd& remainder);

/// Model error that is left where all numbers of a machine are fitted together.
Eigen::VectorXd least_model_error(const Inquiry& inquiry,
                                  const std::vector<Hypothesis>& hypotheses);

/// A fit with its samples over another noise: `factors` times as large as it was.
Fit over_noise(Fit fit, const Eigen::VectorXd& factors, Eigen::Index train);

}  // namespace flexcomp::diagnosis
