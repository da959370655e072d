#pragma once

#include "model/robot.hpp"

namespace flexcomp::effects {

/// How large and strong a machine is: plausible ranges are in proportion to it. Infinite where
/// neither the model nor the recordings tell.
struct MachineSize {
  double reach = 0;          ///< m, of the stretched arm with its tool
  double outreach = 0;       ///< m, the same less the column that carries the second joint
  double payload = 0;        ///< kg, the most that an arm of these masses can carry
  double weight = 0;         ///< N, of the links that move; zero where the model has no masses
  double weight_torque = 0;  ///< N·m, of that weight on the stretched arm
  double force = 0;          ///< N, the largest on the tool
  model::PerJoint<double> effort;    ///< N·m or N, the largest torque of each joint's drive
  model::PerJoint<double> velocity;  ///< rad/s or m/s, the largest speed
  model::PerJoint<double> load;      ///< N·m or N, the largest that each joint's spring bore
};

/// The size of a robot as its model describes it, without loads and force.
MachineSize size_of(const model::Robot& robot);

}  // namespace flexcomp::effects
