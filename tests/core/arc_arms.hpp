#pragma once

#include <cmath>

#include "flexcomp/arc.hpp"

namespace flexcomp::test {

/// An arm with what rigid-body dynamics needs beside its model.
template <typename Scalar, int Joints>
struct Arm {
  RobotModel<Scalar, Joints> model;
  LinkInertia<Scalar, Joints> inertia;
};

/// One joint of compliance 1e-4 rad/(N·m): inertia 4 kg·m², weight 80 N·m · cos q.
template <typename Scalar>
Arm<Scalar, 1> pendulum() {
  const auto mass = Scalar(40);
  const Scalar lever = Scalar(80) / (mass * Scalar(9.81));
  const Scalar across = Scalar(4) - mass * lever * lever;
  Arm<Scalar, 1> arm;
  Joint<Scalar>& joint = arm.model.joints[0];
  joint.axis = -Vector3<Scalar>::UnitY();
  joint.lower = Scalar(-3);
  joint.upper = Scalar(3);
  joint.compliance = Scalar(1e-4);
  joint.mass = mass;
  joint.center_of_mass = Vector3<Scalar>(lever, 0, 0);
  arm.model.gravity = Vector3<Scalar>(0, 0, Scalar(-9.81));
  arm.inertia[0] = Vector3<Scalar>(Scalar(0.1), across, across).asDiagonal();
  return arm;
}

/// Gains of the pendulum's worked example.
template <typename Scalar>
ArcGains<Scalar, 1> pendulum_gains() {
  using One = JointVector<Scalar, 1>;
  ArcGains<Scalar, 1> gains;
  gains.period = Scalar(1e-3);
  gains.rotor_inertia = One(Scalar(1));
  gains.viscous = One(Scalar(6));
  gains.link_rate = One(Scalar(15));
  gains.link_damping = Scalar(40);
  gains.motor_rate = One(Scalar(100));
  gains.motor_damping = Scalar(250);
  gains.motor_stiffness = One(Scalar(5e3));
  gains.filter_frequency = Scalar(600);
  gains.leak = Scalar(5);
  gains.link_adaptation << Scalar(1000), Scalar(0.9), Scalar(40);
  gains.motor_adaptation << Scalar(360), Scalar(160), Scalar(0.9), Scalar(0.225);
  gains.link_gain = One(Scalar(0.02));
  gains.motor_gain = One(Scalar(0.03));
  gains.link_gain_limit = One(Scalar(160));
  gains.motor_gain_limit = One(Scalar(200));
  gains.link_bound_limit = One(Scalar(80));
  gains.motor_bound_limit = One(Scalar(60));
  gains.torque_limit = One(Scalar(400));
  return gains;
}

/// Readings of the pendulum's sensors at `time` (s) of the worked example.
template <typename Scalar>
ArcInput<Scalar, 1> pendulum_input(double time) {
  const double sine = std::sin(2 * time);
  const double cosine = std::cos(2 * time);
  const auto one = [](double value) { return JointVector<Scalar, 1>(static_cast<Scalar>(value)); };
  ArcInput<Scalar, 1> input;
  input.wanted = one(0.3 + 0.1 * sine);
  input.wanted_velocity = one(0.2 * cosine);
  input.wanted_acceleration = one(-0.4 * sine);
  input.link = one(0.299 + 0.0995 * sine);
  input.motor = one(0.3085 + 0.099 * sine);
  input.link_velocity = one(-0.004 + 0.199 * cosine);
  input.motor_velocity = one(0.003 + 0.1985 * cosine);
  return input;
}

/// An arm with skew axes, so that no term of its dynamics is zero by symmetry.
template <typename Scalar, int Joints = 6>
Arm<Scalar, Joints> skew_arm() {
  Arm<Scalar, Joints> arm;
  for (std::size_t i = 0; i < arm.inertia.size(); ++i) {
    const auto n = static_cast<Scalar>(i);
    Joint<Scalar>& joint = arm.model.joints[i];
    joint.origin.position = Vector3<Scalar>(Scalar(0.4), Scalar(0.05) * n, Scalar(0.1));
    joint.axis =
        Vector3<Scalar>(i % 2 == 0 ? Scalar(0.6) : Scalar(0), i % 2 == 0 ? Scalar(0) : Scalar(0.8),
                        i % 2 == 0 ? Scalar(0.8) : Scalar(-0.6));
    joint.lower = Scalar(-3);
    joint.upper = Scalar(3);
    joint.compliance = Scalar(1e-6);
    joint.mass = Scalar(60) - Scalar(9) * n;
    joint.center_of_mass = Vector3<Scalar>(Scalar(0.2), Scalar(0.03) * n, Scalar(-0.05));
    arm.inertia[i] << Scalar(2), Scalar(0.1), Scalar(0.2), Scalar(0.1), Scalar(3), Scalar(-0.3),
        Scalar(0.2), Scalar(-0.3), Scalar(2.5);
  }
  arm.model.tool.position = Vector3<Scalar>(Scalar(0.2), 0, Scalar(0.1));
  arm.model.gravity = Vector3<Scalar>(Scalar(1), Scalar(-2), Scalar(-9.81));
  arm.model.payload_mass = Scalar(20);
  arm.model.payload_center = Vector3<Scalar>(Scalar(0.1), Scalar(-0.05), Scalar(0.2));
  return arm;
}

/// Gains of the same order for every joint: to be executed, not to be judged by.
template <int Joints>
ArcGains<float, Joints> plain_gains() {
  ArcGains<float, Joints> gains;
  gains.period = 1e-3F;
  gains.link_damping = 20;
  gains.motor_damping = 200;
  gains.filter_frequency = 300;
  gains.leak = 5;
  for (auto* const part :
       {&gains.rotor_inertia, &gains.viscous, &gains.link_rate, &gains.motor_rate,
        &gains.motor_stiffness, &gains.link_gain, &gains.motor_gain, &gains.link_gain_limit,
        &gains.motor_gain_limit, &gains.link_bound_limit, &gains.motor_bound_limit}) {
    part->setConstant(10);
  }
  gains.torque_limit.setConstant(5000);
  gains.link_adaptation.setOnes();
  gains.motor_adaptation.setOnes();
  return gains;
}

}  // namespace flexcomp::test
