#pragma once

#include "control/fuzzy.hpp"
#include "simulation/flexible_arm.hpp"

namespace flexcomp::control {

/// Uncertain numbers of an arm. Factors apply to all joints or links of the nominal arm together.
struct ArmUncertainty {
  FuzzyNumber payload = FuzzyNumber::crisp(0);        ///< kg, at the nominal payload's place
  FuzzyNumber link_mass = FuzzyNumber::crisp(1);      ///< factor of all masses and inertias
  FuzzyNumber stiffness = FuzzyNumber::crisp(1);      ///< factor
  FuzzyNumber rotor_inertia = FuzzyNumber::crisp(1);  ///< factor
  FuzzyNumber viscous = FuzzyNumber::crisp(1);        ///< factor
  FuzzyNumber coulomb = FuzzyNumber::crisp(1);        ///< factor of the arm's Coulomb friction
  FuzzyNumber tool_force = FuzzyNumber::crisp(0);     ///< N, unmeasured, at the TCP, any direction
  FuzzyNumber joint_load = FuzzyNumber::crisp(0);     ///< N·m, unmeasured, on any link
  FuzzyNumber start_error = FuzzyNumber::crisp(0);    ///< rad, of each joint at the start
};

/// The most that is asked of an arm.
struct MotionLimits {
  double velocity = 1;      ///< rad/s, of each joint
  double acceleration = 2;  ///< rad/s²
  double jerk = 10;         ///< rad/s³
};

/// Largest and smallest terms of an arm's dynamics over its postures, by sampling the joint range.
template <int Joints>
struct ArmExtremes {
  using Angles = JointVector<double, Joints>;

  /// For a mass of one unit (all links together, or 1 kg of payload), each joint's largest
  struct Unit {
    Angles weight = Angles::Zero();    ///< |G_j|, N·m
    Angles inertia = Angles::Zero();   ///< norm of row j of D, kg·m²
    Angles velocity = Angles::Zero();  ///< norm of the form C_j(q', r), kg·m²
  };
  Unit links;
  Unit payload;                       ///< for 1 kg
  Angles lever = Angles::Zero();      ///< m, of the TCP about the joint
  Angles effective = Angles::Zero();  ///< kg·m², least 1/(D₀⁻¹)_jj of the nominal arm
  double least_inertia = 0;           ///< kg·m², least eigenvalue of D over postures and masses
  double largest_inertia = 0;         ///< kg·m², largest
  double coupling = 0;  ///< largest eigenvalue of M^½ D⁻¹ M^½ with the M given, over both
};

/// Samples the dynamics at a few thousand postures (same ones every time), with a tenth added to
/// what is largest and taken from what is least. `weight` is M. For 1, 2 and 6 joints.
template <int Joints>
ArmExtremes<Joints> sample_extremes(const simulation::FlexibleArm<Joints>& arm,
                                    const ArmUncertainty& uncertainty,
                                    const JointVector<double, Joints>& weight);

}  // namespace flexcomp::control
