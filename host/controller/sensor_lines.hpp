#pragma once

#include <string>

#include "model/robot.hpp"

namespace flexcomp::controller {

/// Lines of flexcompd's configuration for a force sensor of ATI at `address`: the arm's geometry,
/// and the tool that hangs on the sensor, if the robot has one beside its URDF. `frame`: the
/// sensor's in that of the robot's tool link. Throws InputError for a robot of other than six
/// joints.
std::string sensor_lines(const std::string& address, const Pose<double>& frame,
                         const model::Robot& robot);

}  // namespace flexcomp::controller
