#pragma once

#include <Eigen/Core>
#include <vector>

namespace flexcomp::diagnosis {

/// Least squares of numbers of several kinds: their normal equations and the variance of what
/// remains.
struct NormalEquations {
  Eigen::MatrixXd gram;
  Eigen::VectorXd moment;
  double variance = 1;
};

/// Standard deviations by which numbers are held to zero, as the numbers of each kind show
/// themselves how large they are: the ones that make the measurement the most likely (empirical
/// Bayes: MacKay 1992, "Bayesian interpolation"), found by expectation and maximisation (Dempster,
/// Laird and Rubin 1977). `usual`: what each is at first; those of a kind keep their ratios.
/// `kind`: of each number, from 0 on. None becomes smaller than a hundredth of what it was, or
/// larger: numbers that take each other back would.
Eigen::VectorXd learn_widths(const NormalEquations& equations, const Eigen::VectorXd& usual,
                             const std::vector<std::size_t>& kind);

}  // namespace flexcomp::diagnosis
