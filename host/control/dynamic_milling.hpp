#pragma once

#include "control/tracking.hpp"
#include "simulation/milling.hpp"

namespace flexcomp::control {

/// The robot in the cut as it moves: links and motors with their inertia, springs between them, and
/// a controller of the motors that runs several times from one setpoint to the next. Base, link and
/// tool springs give at once.
class DynamicMillingRobot : public simulation::RobotInCut {
 public:
  /// `period` (s): of the setpoints; `control_period` (s): of the controller. Throws InputError
  /// where the first is no multiple of the second. The controller is told the link angles too, and
  /// the torque of the wrench about the joints, as measured.
  DynamicMillingRobot(const simulation::FlexibleArm<6>& arm, const simulation::Process& process,
                      Controller<6> controller, double period, double control_period);

  /// Between setpoints the controller's reference runs straight. The first call finds the robot at
  /// rest there.
  State stand(const JointVector<double, 6>& q_motor, const simulation::Contour::Point& point,
              double load) override;

 private:
  void step(const Reference<6>& reference, const simulation::Contour::Point& point, double load);

  simulation::FlexibleArm<6> arm_;
  model::Chain structure_;  ///< without joint springs
  simulation::Process process_;
  Controller<6> controller_;
  simulation::FlexibleJointPlant<6> plant_;
  double period_;  ///< s
  int ticks_;      ///< of the controller in a period
  bool is_running_ = false;
  JointVector<double, 6> setpoint_ = JointVector<double, 6>::Zero();
  JointVector<double, 6> speed_ = JointVector<double, 6>::Zero();
  State state_{};
};

}  // namespace flexcomp::control
