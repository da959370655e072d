#include "control/dynamic_milling.hpp"

#include <algorithm>
#include <cmath>

#include "flexcomp/chain.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::control {
namespace {

constexpr double kControlPeriod = 1e-3;  // s

}  // namespace

DynamicMillingRobot::DynamicMillingRobot(const simulation::FlexibleArm<6>& arm,
                                         const simulation::Process& process,
                                         Controller<6> controller, double period)
    : arm_(arm),
      structure_(simulation::without_joint_springs(arm.model)),
      process_(process),
      controller_(std::move(controller)),
      plant_(arm),
      period_(period) {}

auto DynamicMillingRobot::stand(const JointVector<double, 6>& q_motor,
                                const simulation::Contour::Point& point, double load) -> State {
  if (!is_running_) {
    plant_.rest(q_motor);
    setpoint_ = q_motor;
    state_ = {point.position, Wrench<double>::Zero(), 1};
    is_running_ = true;
  }
  const JointVector<double, 6> speed = (q_motor - setpoint_) / period_;
  const JointVector<double, 6> acceleration = (speed - speed_) / period_;
  const auto steps = std::max(1, static_cast<int>(std::lround(period_ / kControlPeriod)));
  for (int i = 1; i <= steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    step({setpoint_ + share * (q_motor - setpoint_), speed, acceleration}, point, load);
  }
  setpoint_ = q_motor;
  speed_ = speed;
  return state_;
}

void DynamicMillingRobot::step(const Reference<6>& reference,
                               const simulation::Contour::Point& point, double load) {
  const auto& now = plant_.state();
  const auto kinematics = forward_kinematics<double, 6>(arm_.model, now.link);
  const JointVector<double, 6> torque_of_wrench =
      geometric_jacobian<double, 6>(kinematics).transpose() * state_.wrench;
  const JointVector<double, 6> torque =
      controller_({now.link, now.link_velocity, now.motor, now.motor_velocity, reference.position,
                   reference.velocity, reference.acceleration, torque_of_wrench});
  plant_.advance(torque, torque_of_wrench, kControlPeriod, 4);
  state_.position = simulation::settle(structure_, plant_.state().link, state_.wrench).tcp.position;
  const double deeper = point.normal.dot(state_.position - point.position);
  state_.engagement = std::clamp(1 + deeper / process_.depth_of_cut, 0.0, kMostEngagement);
  state_.wrench = load * state_.engagement * point.wrench;
}

}  // namespace flexcomp::control
