#pragma once

#include <functional>
#include <memory>

#include "simulation/milling.hpp"

namespace flexcomp::simulation {

/// By how much physics beside the springs moves the TCP (m, base frame), its motors at `q_motor`
/// (rad) and a wrench on the tool; called once a period, in order.
using TcpDisplacement =
    std::function<Vector3<double>(const JointVector<double, 6>& q_motor, const Wrench<double>&)>;

/// A robot in the cut whose TCP stands elsewhere by a displacement. It follows the wrench of the
/// period before, and the depth of the cut follows it at once.
class DisplacedRobot : public RobotInCut {
 public:
  DisplacedRobot(std::unique_ptr<RobotInCut> robot, TcpDisplacement displacement)
      : robot_(std::move(robot)), displacement_(std::move(displacement)) {}

  State stand(const JointVector<double, 6>& q_motor, const Contour::Point& point,
              double load) override;

 private:
  std::unique_ptr<RobotInCut> robot_;
  TcpDisplacement displacement_;
  Wrench<double> wrench_ = Wrench<double>::Zero();
};

}  // namespace flexcomp::simulation
