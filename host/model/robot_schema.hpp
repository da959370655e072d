#pragma once

namespace flexcomp::model {

/// Names the form of a robot's YAML file; another form gets another number.
constexpr const char* kRobotSchema = "flexcomp/robot/1";

}  // namespace flexcomp::model
