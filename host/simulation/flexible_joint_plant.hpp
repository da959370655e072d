#pragma once

#include <memory>

#include "simulation/flexible_arm.hpp"

namespace flexcomp::simulation {

/// The arm as differential equations (Spong 1987):
///   D q₁'' + C q₁' + G + K (q₁ − q₂) = τ_ext,   J q₂'' + F q₂' + f(q₂') − K (q₁ − q₂) = u,
/// with Coulomb friction f rounded off below 0.01 rad/s. Rigid-body terms from Orocos KDL, so that
/// a controller and the arm it is tried on share no dynamics. Classical Runge–Kutta, fixed steps.
/// Compiled for 1, 2 and 6 joints.
template <int Joints>
class FlexibleJointPlant {
 public:
  using Angles = JointVector<double, Joints>;

  struct State {
    Angles link = Angles::Zero();            ///< rad
    Angles link_velocity = Angles::Zero();   ///< rad/s
    Angles motor = Angles::Zero();           ///< rad
    Angles motor_velocity = Angles::Zero();  ///< rad/s
  };

  explicit FlexibleJointPlant(const FlexibleArm<Joints>& arm);
  ~FlexibleJointPlant();
  FlexibleJointPlant(const FlexibleJointPlant&) = delete;
  FlexibleJointPlant& operator=(const FlexibleJointPlant&) = delete;

  /// Another arm in the same state: a payload picked up or set down.
  void change_arm(const FlexibleArm<Joints>& arm);

  /// Stands still with its links at `link`, its springs carrying weight and `external` (N·m).
  void rest(const Angles& link, const Angles& external = Angles::Zero());

  /// Moves on under motor torques and external torques on the links (N·m), held for `time` (s).
  void advance(const Angles& torque, const Angles& external, double time, int steps);

  const State& state() const { return state_; }
  void set_state(const State& state) { state_ = state; }

  /// J, kinetic, elastic and potential; without friction it stays.
  double energy() const;

 private:
  struct RigidBody;

  State slope(const State& at, const Angles& torque, const Angles& external) const;

  FlexibleArm<Joints> arm_;
  Angles stiffness_;
  std::unique_ptr<RigidBody> rigid_;
  State state_;
};

}  // namespace flexcomp::simulation
