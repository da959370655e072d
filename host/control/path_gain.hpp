#pragma once

#include "control/loop_gain.hpp"
#include "simulation/milling.hpp"

namespace flexcomp::control {

/// How far a correction may go along a path.
struct GainLimit {
  double stable = 0;  ///< gain at which the loop begins to be unstable somewhere; may be infinite
  double safe = 0;    ///< largest gain, at most one, with a margin of two; never zero (see below)
  /// How many times as deep as nominal the cut becomes: with the safe gain, and should the
  /// correction fade out, as it must on any fault. Infinite where the tool digs in by itself.
  double engagement = 1;
  double engagement_without = 1;

  /// Does the tool dig in, or does no stable gain keep the cut from becoming twice as deep?
  bool digs_in() const { return !(engagement <= kMargin); }

  static constexpr double kMargin = 2;  ///< of the gain (6 dB, as usual for loops) and the depth
  /// Stands for none: zero in a table means "not analysed".
  static constexpr double kNone = 1e-6;
};

/// The least of `largest_safe_gain` along a path, with the process answering as `process` says to
/// the nominal wrench of each row. A path that encloses no area has no sides: there the material is
/// taken to be where it is worst, at right angles to the feed.
///
/// With a gain g the cut becomes 1/(1 − λ (1 − g)) times as deep, λ being `cut_feedback`.
///
/// `softer`: the model's compliances over those that the correction is computed with. Throws
/// InputError for a path without q_cmd or wrench.
GainLimit gain_limit_along(const RobotModel<double, 6>& model, const recording::Recording& path,
                           const simulation::Process& process, const CorrectionLoop& loop,
                           double softer = 1);

}  // namespace flexcomp::control
