#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/fit.hpp"

namespace flexcomp::diagnosis {

/// Channel, and joint less one: the TCP's position (0), or the torque or deflection of one joint.
using Group = std::pair<Channel, Eigen::Index>;

/// Are two groups both of the TCP's position, or both of one joint, whose torque winds it up?
bool are_of_one_place(const Group& a, const Group& b);

/// The evidence for a hypothesis beside the others of a fit.
struct Evidence {
  double delta_bic = 0;     ///< BIC without it less BIC with it
  double p_value = 1;       ///< of so large a gain by chance, times the places looked at
  double confirmation = 0;  ///< deviations by which the held-out sum of squares falls
  /// The held-out error falls in some channel, as it is: single samples far off count there.
  bool lowers_held_out = false;
  double strength = 0;  ///< root mean square of its share in the component that shows it most,
                        ///< over the noise
  /// Groups whose prediction it moves by more than the noise, or the one that it moves most.
  std::vector<Group> shows;
  /// That shows it most, over the noise or, where that is more, over what the whole fit leaves
  /// there. What follows is of that group.
  Group group;
  double relative_strength = 0;  ///< to that of the whole fit
  double share = 0;              ///< of the power that is left beyond the noise without it; the
                                 ///< noise is no more than what is left with it
  double beyond_noise = 0;       ///< what was beyond the noise over what it takes away
  double explained = 0;          ///< part of the mismatch's power that the whole fit accounts for
  double left = 0;               ///< by the whole fit, times the noise
  double effective_samples = 0;
  std::string impossible;  ///< why it cannot be so, as fitted; empty if it can
};

constexpr double kStrongEvidence = 10;  ///< of BIC: "very strong" (Kass and Raftery 1995)
constexpr double kSameEvidence = 6;     ///< of BIC: below "strong" (the same)
/// Times the noise: a remainder no larger counts as explained, since noise is estimated to a tenth.
constexpr double kLikeNoise = 1.15;

/// Compares two fits to the same observations; `with` has one hypothesis more, its last, or that
/// and others weighed together with it.
/// `places`: how many hypotheses were looked at to find it.
Evidence weigh(const Observations& observations, const Fit& without, const Fit& with,
               double places);

/// Deviations by which the squares that were held out fall from one remainder to another.
double confirmation_of(const Observations& observations, const Eigen::VectorXd& before,
                       const Eigen::VectorXd& after);

/// Number of independent samples to fit to, by how long a remainder hangs together: their number
/// over the variance of its mean, in terms of what it would be if they were independent
/// (correlated_widening). Neighbours alone would not tell: a remainder as smooth as a motion has
/// nearly the same value twice, whether it is the next for a tenth of a second or for ten.
double independent_samples(const Observations& observations, const Eigen::VectorXd& remainder);

/// Schwarz's criterion: n·ln(before/after) less ln(n) for each parameter; n independent samples.
double bic_gain(double samples, double sum_before, double sum_after, std::size_t parameters);

/// Gain in BIC of a fit over a plainer one, which may have more parameters. A parameter counts as
/// far as the samples tell it, and not where a tolerance holds it.
double bic_gain(const Observations& observations, const Fit& plain, const Fit& rich);

/// Does a group's remainder come near the noise where it was fitted, but fail on what was held out?
/// Then the fit imitates the machine. Always false in a load test, whose samples are too few, and
/// their noise too little known, to tell.
bool fails_held_out(const Observations& observations, const Eigen::VectorXd& remainder,
                    const Group& group);

/// Root mean square of the remainder of the samples to fit to, over the measurement's noise, in the
/// channel where it is largest.
double largest_ratio(const Observations& observations, const Eigen::VectorXd& remainder);

/// Does the held-out error fall noticeably in a channel from one fit to another, and rise in none?
bool predicts_better(const Observations& observations, const Fit& before, const Fit& after);

}  // namespace flexcomp::diagnosis
