#include "control/dynamic_milling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "flexcomp/chain.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::control {
namespace {

/// How often a controller runs from one setpoint to the next.
int ticks_between(double setpoint_period, double control_period) {
  const int ticks =
      std::max(1, static_cast<int>(std::ceil(setpoint_period / control_period - 1e-9)));
  if (std::abs(setpoint_period / ticks - control_period) > 1e-9 * control_period) {
    throw InputError(fmt::format(
        "the period of the setpoints, {:g} s, must be a multiple of the design's, {:g} s",
        setpoint_period, control_period));
  }
  return ticks;
}

}  // namespace

DynamicMillingRobot::DynamicMillingRobot(const simulation::FlexibleArm<6>& arm,
                                         const simulation::Process& process,
                                         Controller<6> controller, double period,
                                         double control_period)
    : arm_(arm),
      structure_(model::chain_of(simulation::without_joint_springs(arm.model))),
      process_(process),
      controller_(std::move(controller)),
      plant_(arm),
      period_(period),
      ticks_(ticks_between(period, control_period)) {}

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
  for (int i = 1; i <= ticks_; ++i) {
    const double share = static_cast<double>(i) / ticks_;
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
  plant_.advance(torque, torque_of_wrench, period_ / ticks_, 4);
  state_.position = simulation::settle(structure_, plant_.state().link, state_.wrench).tcp.position;
  const double deeper = point.normal.dot(state_.position - point.position);
  state_.engagement = std::clamp(1 + deeper / process_.depth_of_cut, 0.0, kMostEngagement);
  state_.wrench = load * state_.engagement * point.wrench;
}

}  // namespace flexcomp::control
