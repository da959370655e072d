#pragma once

#include "check/check.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"

namespace flexcomp::check {

/// Columns that say nothing: constant or empty ones, samples that are missing or repeated, coarse
/// encoders. Names: column.constant, column.empty, samples.missing, samples.repeated,
/// encoder.coarse. With `columns`, whether the recording is of as many joints as the robot:
/// joint.count.
Checks check_columns(const recording::Recording& recording);

/// Joints of which a recording tells nothing, whatever is done with it: those that never move, and
/// joints that only move together. Names: motion.none, motion.together.
Checks check_motion(const recording::Recording& recording);

/// Angles, speeds and torques beyond what the joints can do: limits.
Checks check_limits(const model::Robot& robot, const recording::Recording& recording);

}  // namespace flexcomp::check
