#pragma once

#include <optional>
#include <vector>

#include "flexcomp/chain.hpp"

namespace flexcomp::planning {

/// All joint angles (rad, to whole turns, limits not looked at) that put the TCP of an industrial
/// robot at `target` (base frame): two ways round joint 1, two elbows, two wrists, so at most
/// eight.
///
/// In closed form (Pieper 1968; Brandstötter et al. 2014 for this kind of robot): joint 1 turns
/// about the base's z axis, joints 2 and 3 are parallel and move the wrist in the plane y = 0 when
/// joint 1 is at zero, the last three axes meet in a point, joint 5 across the two beside it, which
/// are in line when joint 5 is at zero. Of any other robot, nothing.
std::optional<std::vector<JointVector<double, 6>>> solve_closed_form(
    const RobotModel<double, 6>& model, const Pose<double>& target);

}  // namespace flexcomp::planning
