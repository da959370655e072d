#pragma once

#include "flexcomp/inverse_dynamics.hpp"

namespace flexcomp::simulation {

/// An arm whose motors turn its links through springs; all on the joint side of the gears.
template <int Joints>
struct FlexibleArm {
  using Angles = JointVector<double, Joints>;

  RobotModel<double, Joints> model;       ///< geometry, joint springs, masses, payload
  LinkInertia<double, Joints> inertia;    ///< kg·m²
  Angles rotor_inertia = Angles::Zero();  ///< kg·m²
  Angles viscous = Angles::Zero();        ///< N·m·s/rad, at the motors
  Angles coulomb = Angles::Zero();        ///< N·m, at the motors
  Angles torque_limit = Angles::Zero();   ///< N·m

  Angles stiffness() const {
    return Angles::NullaryExpr([this](Eigen::Index i) {
      return 1 / model.joints[static_cast<std::size_t>(i)].compliance;
    });
  }
};

}  // namespace flexcomp::simulation
