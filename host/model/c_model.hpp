#pragma once

#include <string>

#include "model/robot.hpp"

namespace flexcomp::model {

/// A header in C and C++ with the robot as `flexcomp_model_t robot_model` and its fingerprint as
/// `ROBOT_MODEL_HASH`: for a controller that makes tables itself or needs the robot's kinematics.
/// Every number is that of the model rounded to `float`, so that the core finds the same
/// fingerprint. Throws InputError for a machine that is not six revolute joints with limits.
std::string c_model_text(const Robot& robot);

}  // namespace flexcomp::model
