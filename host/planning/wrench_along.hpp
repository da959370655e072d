#pragma once

#include "planning/inverse_kinematics.hpp"
#include "recording/recording.hpp"

namespace flexcomp::planning {

/// The wrench along a path (joint angles, a row a point) as it acted along another that goes the
/// same way, such as the corrected one that a program was written from: from the place nearest to
/// each row, never backwards, straight between the rows there. Throws InputError where the other
/// lacks q_cmd or the wrench, or keeps farther than `farthest` (m) away.
recording::Samples wrench_along(const RobotModel<double, 6>& model, const recording::Samples& q,
                                const recording::Recording& other, double farthest = 0.01);

}  // namespace flexcomp::planning
