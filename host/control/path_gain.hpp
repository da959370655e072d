#pragma once

#include "control/loop_gain.hpp"
#include "simulation/milling.hpp"

namespace flexcomp::control {

/// How far a correction may go along a path.
struct GainLimit {
  double stable = 0;  ///< gain at which the loop begins to be unstable somewhere; may be infinite
  double safe = 0;    ///< largest gain, at most one, with a margin of two; never zero (see below)
  bool digs_in = false;  ///< somewhere the process draws the tool in without any correction

  /// Stands for none: zero in a table means "not analysed".
  static constexpr double kNone = 1e-6;
};

/// The least of `largest_safe_gain` along a path, with the process answering as `process` says to
/// the nominal wrench of each row. A path that encloses no area has no sides: there the material is
/// taken to be where it is worst, at right angles to the feed.
///
/// `softer`: the model's compliances over those that the correction is computed with. Throws
/// InputError for a path without q_cmd or wrench.
GainLimit gain_limit_along(const RobotModel<double, 6>& model, const recording::Recording& path,
                           const simulation::Process& process, const CorrectionLoop& loop,
                           double softer = 1);

}  // namespace flexcomp::control
