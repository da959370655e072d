#include "effects/terms.hpp"

namespace flexcomp::effects {

void add_joint_angle(const Simulation& simulation, int joint, const Eigen::VectorXd& angle,
                     Prediction* prediction) {
  simulation::add_joint_angle(simulation, joint, angle, angle, prediction);
}

void add_load_driven(const Simulation& simulation, int joint,
                     const std::function<Eigen::VectorXd(const Eigen::VectorXd& load)>& angle,
                     Prediction* prediction) {
  const Eigen::VectorXd at_rest = angle(prediction->load.col(joint - 1));
  const bool by_motion = prediction->channel[simulation::joint_deflection].cols() > 0;
  simulation::add_joint_angle(simulation, joint, at_rest,
                              by_motion ? angle(prediction->dynamic_load.col(joint - 1)) : at_rest,
                              prediction);
}

void add_torque(int joint, const Eigen::VectorXd& torque, Prediction* prediction) {
  if (prediction->channel[simulation::joint_torque].cols() > 0) {
    prediction->channel[simulation::joint_torque].col(joint - 1) += torque;
  }
}

void alter_shown_torque(int joint, const std::function<void(Eigen::Ref<Eigen::VectorXd>)>& alter,
                        Prediction* prediction) {
  Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
  for (Eigen::Index column = 0; column < torque.cols(); ++column) {
    if (joint == 0 || joint == column + 1) {
      alter(torque.col(column));
    }
  }
}

Eigen::ArrayXd directions(const Simulation& simulation, int joint) {
  return simulation.velocity.col(joint - 1).array().unaryExpr(
      [](double speed) { return static_cast<double>(simulation::direction_of_motion(speed)); });
}

Eigen::VectorXd ripple(const Simulation& simulation, int joint, const std::vector<double>& values) {
  const Eigen::ArrayXd wave = values[2] * simulation.q.col(joint - 1).array();
  return values[0] * wave.sin() + values[1] * wave.cos();
}

}  // namespace flexcomp::effects
