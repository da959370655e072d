#include "check/arm.hpp"

#include <algorithm>

#include "model/chain_kinematics.hpp"
#include "simulation/inverse_dynamics.hpp"

namespace flexcomp::check {

Eigen::Index joint_count(const model::Robot& robot) {
  return static_cast<Eigen::Index>(robot.elastic.joints.size());
}

const model::ChainJoint& joint_of(const model::Robot& robot, Eigen::Index joint) {
  return robot.elastic.joints[static_cast<std::size_t>(joint)];
}

bool turns(const model::Robot& robot, Eigen::Index joint) {
  return !joint_of(robot, joint).slides();
}

Pose<double> tcp_at(const model::Robot& robot, const Eigen::RowVectorXd& q) {
  return forward_kinematics(robot.elastic, q.transpose()).tcp;
}

Eigen::MatrixXd jacobian_at(const model::Robot& robot, const Eigen::RowVectorXd& q) {
  return geometric_jacobian(robot.elastic, forward_kinematics(robot.elastic, q.transpose()));
}

Eigen::RowVectorXd torque_at(const model::Robot& robot, const Eigen::RowVectorXd& q,
                             const Eigen::RowVectorXd& velocity,
                             const Eigen::RowVectorXd& acceleration) {
  return simulation::inverse_dynamics(robot, q.transpose(), velocity.transpose(),
                                      acceleration.transpose())
      .transpose();
}

model::Robot with_gravity(model::Robot robot, const Vector3<double>& gravity) {
  robot.elastic.gravity = gravity;
  return robot;
}

bool has_masses(const model::Robot& robot) {
  const auto& joints = robot.elastic.joints;
  const double tool = robot.tool ? robot.tool->mass : 0;
  return std::any_of(joints.begin(), joints.end(), [&](const model::ChainJoint& joint) {
    return joint.mass > (&joint == &joints.back() ? tool : 0);
  });
}

}  // namespace flexcomp::check
