#pragma once

#include "check/check.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"

/// Checks that need the physics: signs and units of wrench and torques, weight. On recordings whose
/// positions and angles are as they should be.
namespace flexcomp::check {

/// Does what bends bend with the wrench, rather than against it (wrench.sign), and in the base
/// frame rather than the tool's (wrench.frame), by as much as the springs say, to some orders of
/// magnitude (units.wrench)? By the measured positions, the joints' deflections and their torques,
/// as far as they are there.
Checks check_wrench(const model::Robot& robot, const recording::Recording& recording);

/// Do the torques go with inertia, weight and friction as the model has them: torque.sign,
/// torque.unit; joint.sign or joint.order where they would with an angle turned or two swapped;
/// gravity.missing where they carry a weight that the model leaves out. Without torques the joints'
/// deflections tell of the angles. Angles that are `proved` (by positions) are not doubted.
/// `recording` is corrected by what is named.
Checks check_torques(const model::Robot& robot, bool proved, recording::Recording* recording);

}  // namespace flexcomp::check
