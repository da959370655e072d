#pragma once

#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "control/arm_uncertainty.hpp"
#include "flexcomp/arc.hpp"
#include "simulation/flexible_joint_plant.hpp"

namespace flexcomp::control {

/// Where an arm is wanted at one moment.
template <int Joints>
struct Reference {
  JointVector<double, Joints> position;      ///< rad
  JointVector<double, Joints> velocity;      ///< rad/s
  JointVector<double, Joints> acceleration;  ///< rad/s²
};

/// A motion to be tracked by an arm that is not quite as its controller believes.
template <int Joints>
struct TrackingJob {
  using Angles = JointVector<double, Joints>;

  simulation::FlexibleArm<Joints> arm;                       ///< the true one
  std::optional<simulation::FlexibleArm<Joints>> later_arm;  ///< from `change_time` on, if any
  double change_time = 0;                                    ///< s
  std::function<Reference<Joints>(double time)> reference;
  /// N·m, on the links from outside, at a time and link angles; not known to the controller.
  std::function<Angles(double time, const Angles& link)> load;
  Angles start_error = Angles::Zero();  ///< rad, link less wanted, at rest
  double duration = 10;                 ///< s
  double settled = 5;                   ///< s, from which the figures count
  double period = 1e-3;                 ///< s
  int steps = 2;                        ///< of the integration in a period
};

/// Errors of the links, from `settled` on.
template <int Joints>
struct TrackingFigures {
  using Angles = JointVector<double, Joints>;

  Angles largest_error = Angles::Zero();  ///< rad
  Angles error = Angles::Zero();          ///< rad, root mean square
  Angles torque = Angles::Zero();         ///< N·m, root mean square
  Angles torque_change = Angles::Zero();  ///< N·m, root mean square, from one period to the next
};

/// Motor torques for what sensors and reference say.
template <int Joints>
using Controller = std::function<JointVector<double, Joints>(const ArcInput<double, Joints>&)>;

/// Called every period with the time, what the controller was told and what it answered.
template <int Joints>
using Observer = std::function<void(double time, const ArcInput<double, Joints>& input,
                                    const JointVector<double, Joints>& torque)>;

/// Simulates a job; a controller that loses the arm shows in the figures. For 1, 2 and 6 joints.
template <int Joints>
TrackingFigures<Joints> track(const TrackingJob<Joints>& job, const Controller<Joints>& controller,
                              const Observer<Joints>& observer = {});

/// Proportional-derivative control of the motors, as a robot's own servo does it, with the torque
/// limit: u = −K_p (q₂ − q_d) − K_d (q₂' − q_d').
template <int Joints>
struct PdGains {
  JointVector<double, Joints> proportional;  ///< N·m/rad
  JointVector<double, Joints> derivative;    ///< N·m·s/rad
  JointVector<double, Joints> torque_limit;  ///< N·m
};
template <int Joints>
Controller<Joints> pd_controller(const PdGains<Joints>& gains);

/// Adds to a controller the torques that the nominal arm would need to follow the reference:
/// weight, inertia, viscous friction. Throws std::invalid_argument for an arm that cannot be.
template <int Joints>
Controller<Joints> with_feed_forward(const simulation::FlexibleArm<Joints>& nominal,
                                     Controller<Joints> controller);

/// The stiffness and damping that the motor loop of adaptive robust control has in itself.
template <int Joints>
PdGains<Joints> matching_pd(const ArcGains<double, Joints>& gains);

/// An arm of which all that is uncertain has been drawn, evenly from the supports, and the size of
/// the loads on it.
template <int Joints>
struct DrawnArm {
  simulation::FlexibleArm<Joints> arm;
  double tool_force = 0;  ///< N
  double joint_load = 0;  ///< N·m
};
template <int Joints>
DrawnArm<Joints> draw_arm(const simulation::FlexibleArm<Joints>& nominal,
                          const ArmUncertainty& uncertainty, std::mt19937_64* random);

}  // namespace flexcomp::control
