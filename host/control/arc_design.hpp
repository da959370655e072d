#pragma once

#include <array>

#include "control/arm_uncertainty.hpp"
#include "control/gain_cost.hpp"
#include "control/lyapunov_bound.hpp"
#include "flexcomp/arc.hpp"

namespace flexcomp::control {

/// How fast the loops are, in the order in which they stand above each other.
struct ArcBandwidth {
  double period = 1e-3;           ///< s
  double link_rate = 15;          ///< 1/s, S₁
  double link_damping = 40;       ///< 1/s, k_v
  double motor_rate = 100;        ///< 1/s, S₂
  double motor_damping = 250;     ///< 1/s, k₂
  double motor_stiffness = 5000;  ///< 1/s², K_p2 over J₀
  double filter_frequency = 600;  ///< rad/s
  double leak = 5;                ///< 1/s
  double link_gain_limit = 80;    ///< 1/s, over the least effective inertia of the link
  double motor_gain_limit = 200;  ///< 1/s, over J₀
  double surface_speed = 0.002;   ///< rad/s, of s at which an adapted bound is as large as typical
  double residual_time = 2;  ///< s, β: weight of where the error settles against getting there
  double effort = 0.05;  ///< weight of effort; at 1 a robust term about doubles its loop's damping
};

/// One robust term: link or motor side of one joint.
template <int Count>
struct ArcPart {
  std::array<FuzzyNumber, Count> parameters;  ///< α of the bound function α·Π
  Eigen::Matrix<double, Count, 1> typical;    ///< D-operation of each, at least a trace
  double bound_limit = 0;                     ///< N·m, ρ_max
  double gain_limit = 0;                      ///< N·m·s/rad
  GainProblem problem;
  GainCost cost{};
  double root = 0;  ///< 1/W, gain of least cost: root of the quartic
  /// 1/W, γ: the root, or less so that the slope never comes to its limit, ρ_max² γ ≤ gain_limit.
  /// The cost falls up to the root, so this is the best of the gains that are allowed.
  double gain = 0;

  ArcPart();
};

/// Guarantee of a controller for every arm within the supports of the fuzzy sets, for motions
/// within the limits and torques that are not clamped.
struct ArcGuarantee {
  LyapunovBound bound{};
  double start = 0;                  ///< J, V at the start at most
  double coupling = 0;               ///< c, weight of the motor's part in V
  double least_inertia = 0;          ///< kg·m²
  double least_stiffness = 0;        ///< N·m/rad
  double least_motor_stiffness = 0;  ///< N·m/rad, K_p2
  double stiffness_share = 0;        ///< κ_, least K/K₀
  double filter_drift = 0;           ///< W, the part of δ that the filter causes

  /// Radii (rad, rad/s, rad, √J) of the balls around zero at a level of V: tracking error e, its
  /// surface s₁, motor error x₃, and parameter errors with √(α̃ᵀΓ⁻¹α̃).
  double tracking_error(double level) const;
  double link_surface(double level) const;
  double motor_error(double level) const;
  double link_parameters(double level) const;
  double motor_parameters(double level) const;
};

template <int Joints>
struct ArcDesign {
  std::array<ArcPart<3>, static_cast<std::size_t>(Joints)> link;
  std::array<ArcPart<4>, static_cast<std::size_t>(Joints)> motor;
  ArcGains<double, Joints> gains;
  ArcGuarantee guarantee;
  JointVector<double, Joints> elastic_rate;  ///< N·m/s, largest |w*'| the guarantee reckons with
};

/// From an arm, what is uncertain of it and what is asked of it to gains and guarantee. The
/// derivation stands in host/control/README.md. Throws InputError where the uncertainty is none
/// that can be (a stiffness factor down to zero). For 1, 2 and 6 joints.
template <int Joints>
ArcDesign<Joints> design_arc(const simulation::FlexibleArm<Joints>& arm,
                             const ArmUncertainty& uncertainty, const MotionLimits& motion,
                             const ArcBandwidth& bandwidth);

}  // namespace flexcomp::control
