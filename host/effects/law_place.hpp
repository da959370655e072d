#pragma once

#include <string>

#include "formula/unit.hpp"
#include "model/robot.hpp"
#include "simulation/machine.hpp"

namespace flexcomp::effects {

/// Where a formula's value acts, as `robot.yaml` says it.
enum class PlaceKind {
  joint_torque,       ///< adds to a drive's torque
  joint_angle,        ///< the joint stands elsewhere; TCP and link encoder see it
  joint_windup,       ///< the same, driven by the load: at rest for the TCP, with inertia for the
                      ///< encoder
  tcp_base,           ///< the TCP moves along an axis of the base frame
  tcp_tool,           ///< the same of the tool frame
  base,               ///< the base moves along an axis, or turns about one
  sensor_wrench,      ///< the force sensor shows so much more, tool frame
  sensor_position,    ///< so does what measures the TCP
  sensor_torque,      ///< so does what measures a joint's torque
  sensor_deflection,  ///< so does a joint's link encoder
};

struct LawPlace {
  PlaceKind kind = PlaceKind::joint_torque;
  int joint = 0;  ///< from 1 on; 0 where it has none
  int axis = 0;   ///< x, y, z: 0 to 2; about them: 3 to 5
};

/// A place by what a file says: `place`, `axis` (empty where there is none) and `joint`. Throws
/// std::invalid_argument with what was expected.
LawPlace read_place(const std::string& place, const std::string& axis, int joint);

/// Unit of what acts at a place.
std::string unit_at(const LawPlace& place, const model::Robot& robot);

/// The stage in which it acts (simulation/machine.hpp).
simulation::Term::Stage stage_at(const LawPlace& place);

/// Does what acts there move the robot, or only what is measured of it?
bool moves_the_robot(const LawPlace& place);

/// "joint 5 has a torque", to be followed by "that …".
std::string in_words(const LawPlace& place);

/// Adds values at a place, one a row; `with_inertia`: what a link encoder sees of a wind-up.
void add_at(const LawPlace& place, const Eigen::VectorXd& values,
            const Eigen::VectorXd& with_inertia, const simulation::Simulation& at,
            simulation::Prediction* prediction);

}  // namespace flexcomp::effects
