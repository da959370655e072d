#pragma once

#include "flexcomp/model.hpp"
#include "recording/recording.hpp"
#include "study/milling_force.hpp"

namespace flexcomp::study {

/// How a tool turns while it follows a path.
struct Spindle {
  double speed = 0;     ///< rad/s, clockwise seen from the spindle; not used for mean wrenches
  bool is_mean = true;  ///< the mean over a revolution instead of every tooth's pass
};

/// The path (t, q_cmd) with the wrench of milling along it: the feed where the TCP goes, the tool's
/// tip at the TCP, its axis along the TCP's z axis, which points into the work; base frame.
///
/// Where the TCP stands the tool is out of the cut, and the wrench zero. Throws InputError for a
/// path that lacks q_cmd, moves along the tool's axis alone, or, with teeth passing, has rows more
/// than an eighth of a tooth's pass apart.
recording::Recording with_milling_wrench(const RobotModel<double, 6>& model,
                                         recording::Recording path, const EndMilling& milling,
                                         const Spindle& spindle);

}  // namespace flexcomp::study
