#pragma once

#include <memory>

#include "model/robot.hpp"

namespace flexcomp::simulation {

/// Rigid-body inverse dynamics of a robot by recursive Newton–Euler (Orocos KDL): torque (N·m)
/// about each joint for a motion, weight included, without friction, rotors and external wrench.
class InverseDynamics {
 public:
  explicit InverseDynamics(const model::Robot& robot);
  ~InverseDynamics();

  JointVector<double, 6> torque(const JointVector<double, 6>& q,
                                const JointVector<double, 6>& velocity,
                                const JointVector<double, 6>& acceleration) const;

 private:
  struct Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace flexcomp::simulation
