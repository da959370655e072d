#include "simulation/displaced_robot.hpp"

namespace flexcomp::simulation {

RobotInCut::State DisplacedRobot::stand(const JointVector<double, 6>& q_motor,
                                        const Contour::Point& point, double load) {
  const Vector3<double> displacement = displacement_(q_motor, wrench_);
  // A tool that is moved towards the material meets it as if the contour came as much nearer.
  Contour::Point nearer = point;
  nearer.position -= displacement;
  State state = robot_->stand(q_motor, nearer, load);
  state.position += displacement;
  wrench_ = state.wrench;
  return state;
}

}  // namespace flexcomp::simulation
