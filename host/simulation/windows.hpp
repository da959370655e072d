#pragma once

#include "simulation/differentiation.hpp"

namespace flexcomp::simulation {

/// Polynomials by which the joints' accelerations are least wrong: over a short window they let the
/// angles' noise through, over a long one they cut the motion's corners.
///
/// Both are measured, away from the recording's ends. The noise of an acceleration is that of the
/// angles times the polynomial's gain, and a factor that a longer window tells: an encoder's counts
/// are no independent errors. What a window differs by from any shorter one beyond their noise is
/// what it cuts (Lepski 1991; Goldenshluger and Lepski 2011): of nested least squares the variance
/// of the difference is the difference of the variances. The shortest alone would not do, since its
/// noise hides what the longer ones cut. The shortest is kept unless noise rules it.
std::vector<JointPolynomials> best_polynomials(const Eigen::VectorXd& time,
                                               const recording::Samples& q,
                                               const Eigen::RowVectorXd& angle_noise);

}  // namespace flexcomp::simulation
