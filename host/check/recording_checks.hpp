#pragma once

#include "check/check.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"

namespace flexcomp::check {

/// All that is asked of a recording. Units come first, then positions, then signs: what is found is
/// corrected in a copy, so that one slip is told once and what else is wrong shows. Without a
/// robot, what can be said without one.
Checks check_recording(const model::Robot* robot, recording::Recording recording);

}  // namespace flexcomp::check
