#pragma once

#include <Eigen/Core>

#include "model/robot.hpp"

/// A robot as the checks see it: stiff, any number of joints.
namespace flexcomp::check {

Eigen::Index joint_count(const model::Robot& robot);

const model::ChainJoint& joint_of(const model::Robot& robot, Eigen::Index joint);

/// Does the joint turn? Angles of one that slides are lengths.
bool turns(const model::Robot& robot, Eigen::Index joint);

/// TCP at joint angles, without any spring.
Pose<double> tcp_at(const model::Robot& robot, const Eigen::RowVectorXd& q);

/// Geometric Jacobian of the TCP (6 × joints), linear rows first, base frame.
Eigen::MatrixXd jacobian_at(const model::Robot& robot, const Eigen::RowVectorXd& q);

/// Torques of inertia and weight (N·m), without friction and wrench.
Eigen::RowVectorXd torque_at(const model::Robot& robot, const Eigen::RowVectorXd& q,
                             const Eigen::RowVectorXd& velocity,
                             const Eigen::RowVectorXd& acceleration);

/// The same robot with another gravity (m/s², base frame).
model::Robot with_gravity(model::Robot robot, const Vector3<double>& gravity);

/// Has any moving link a mass, its tool aside?
bool has_masses(const model::Robot& robot);

}  // namespace flexcomp::check
