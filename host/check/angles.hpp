#pragma once

#include "check/check.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"

namespace flexcomp::check {

/// Units of joint angles by the joints' limits, and signs of one group of angles by another:
/// units.angle, joint.sign. `recording` is corrected by what is named.
Checks check_angles(const model::Robot& robot, recording::Recording* recording);

/// Angles that lie outside their joint's limits as they stand, and within with the other sign:
/// joint.sign. A weak hint, for recordings that show nothing better. Corrects `recording`.
Checks check_signs_by_limits(const model::Robot& robot, recording::Recording* recording);

}  // namespace flexcomp::check
