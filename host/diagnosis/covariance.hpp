#pragma once

#include <Eigen/Core>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// Covariance of the parameters of a fit, by the prediction's derivative (samples to fit to ×
/// parameters, over the noise), the samples' weights, the remainder, the precision by which each
/// parameter is held to the model beside the samples (zero: not at all), and the variance of a
/// sample of weight one.
///
/// It is that of independent errors, widened where errors hang together over time (a late clock, a
/// remainder that nothing accounts for): then the scores of whole stretches scatter more than those
/// of as many independent samples (Liang and Zeger 1986). It is never narrowed: there are few
/// stretches. Zero where nothing depends on a parameter.
Eigen::MatrixXd covariance_of(const Observations& observations, const Eigen::MatrixXd& derivative,
                              const Eigen::VectorXd& weight, const Eigen::VectorXd& remainder,
                              const Eigen::VectorXd& precision, double variance);

/// How many parameters a fit tells, rather than what holds them: each counts by the part of its
/// precision that the samples give (MacKay 1992, "Bayesian interpolation"). Arguments as above.
double told_parameters(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight,
                       const Eigen::VectorXd& precision);

/// Times the variance of a number whose scores (derivative times weighted remainder, by sample)
/// were independent of each other: scores that are correlated over time tell less (Newey and West
/// 1987, Bartlett's weights). Quicker than the above, and never less than one.
double correlated_widening(const Observations& observations, const Eigen::VectorXd& score);

}  // namespace flexcomp::diagnosis
