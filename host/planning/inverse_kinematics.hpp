#pragma once

#include <optional>
#include <vector>

#include "flexcomp/chain.hpp"

namespace flexcomp::planning {

using Angles = JointVector<double, 6>;

/// Joint angles that put the TCP at `target` (base frame) to 1e-9 m and rad, found near `seed` and
/// within the joint limits; nothing if there are none. By KDL's Levenberg–Marquardt solver.
std::optional<Angles> solve_near(const RobotModel<double, 6>& model, const Pose<double>& target,
                                 const Angles& seed);

/// Different joint angles that put the TCP at `target`, from many seeds, those farthest from the
/// joint limits first.
std::vector<Angles> solve_all(const RobotModel<double, 6>& model, const Pose<double>& target);

}  // namespace flexcomp::planning
