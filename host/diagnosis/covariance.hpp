#pragma once

#include <Eigen/Core>

#include "diagnosis/observations.hpp"

namespace flexcomp::diagnosis {

/// The inverse of a fit's normal equations, inner(i, j) · unit[i] · unit[j] for parameters i and j.
/// In these units each parameter is told alike. The unit of a parameter on which nothing depends,
/// and which nothing holds, is endless.
struct NormalInverse {
  Eigen::VectorXd unit;
  Eigen::MatrixXd gram;  ///< the equations in these units
  Eigen::MatrixXd inner;
};

/// The inverse by the prediction's derivative (samples to fit to × parameters, over the noise), the
/// samples' weights, and the precision by which each parameter is held to the model beside the
/// samples (zero: not at all).
NormalInverse inverse_of(const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight,
                         const Eigen::VectorXd& precision);

/// Covariance of the parameters of a fit with such an inverse, by the remainder and the variance of
/// a sample of weight one.
///
/// It is the covariance for independent errors, widened where errors hang together: over time (a
/// late clock, a drift), or at a posture (an error of the model there is the same in every round).
/// The fit is repeated, to first order, without each cluster in turn, and each parameter's
/// deviation is at least what these fits scatter by: the jackknife by clusters (Bell and McCaffrey
/// 2002, "CR3"; Cameron, Gelbach and Miller 2008). It is never narrowed: there are few clusters.
/// Zero where nothing depends on a parameter.
///
/// What the accelerations may all be wrong by alike is added: an inertia that a joint moves would
/// take it up, and leave nothing.
Eigen::MatrixXd covariance_of(const Observations& observations, const NormalInverse& inverse,
                              const Eigen::MatrixXd& derivative, const Eigen::VectorXd& weight,
                              const Eigen::VectorXd& remainder, double variance);

/// Number of parameters that the samples of a fit with such an inverse tell: each counts by the
/// part of its precision that the samples, and not a tolerance, give (MacKay 1992, "Bayesian
/// interpolation").
double told_parameters(const NormalInverse& inverse, const Eigen::VectorXd& precision);

/// Variance of a number over its variance if its scores (derivative times weighted remainder, by
/// sample) were independent: scores that are correlated over time tell less (Newey and West
/// 1987, Bartlett's weights). Quicker than the above, and never less than one.
double correlated_widening(const Observations& observations, const Eigen::VectorXd& score);

}  // namespace flexcomp::diagnosis
