#pragma once

#include <cmath>

#include "effects/learned.hpp"
#include "model/robot.hpp"
#include "simulation/scene.hpp"

namespace flexcomp::test {

/// A KR 270 under gravity that swings all joints, pushed by a changing force, at 100 Hz; with every
/// column that a recording can have.
struct MovingRobot {
  model::Robot robot;
  recording::Recording recording;

  explicit MovingRobot(Eigen::Index rows = 200)
      : robot(model::load_robot(FLEXCOMP_ROBOTS "/kr270/robot.yaml")) {
    constexpr double kMiddle[] = {0, -1.2, 1.4, 0.3, 0.6, 0.1};
    robot.elastic.gravity = {0, 0, -9.81};
    recording.file = "moving.csv";
    recording.time = Eigen::VectorXd::LinSpaced(rows, 0, 0.01 * static_cast<double>(rows - 1));
    recording::Samples q(rows, 6);
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      const double omega = 4 + static_cast<double>(joint);
      q.col(joint) = kMiddle[joint] + 0.2 * (omega * recording.time.array()).sin();
    }
    recording.q_cmd = q;
    recording.q_meas = q;
    recording.q_link = q;
    recording.tau = recording::Samples::Zero(rows, 6);
    recording.position = recording::Samples::Zero(rows, 3);
    recording.wrench = recording::Samples::Zero(rows, 6);
    recording.wrench->col(0) = 500 * (3 * recording.time.array()).cos();
    recording.wrench->col(2).setConstant(-800);
    recording.temperature = 20 + recording.time.array();
  }

  simulation::Scene scene() const {
    simulation::Preparation preparation;
    return simulation::prepare(recording, recording.size(), &preparation);
  }

  /// The same without encoders: the scene follows the command.
  simulation::Scene commanded() const {
    recording::Recording blind = recording;
    blind.q_meas.reset();
    blind.q_link.reset();
    simulation::Preparation preparation;
    return simulation::prepare(blind, blind.size(), &preparation);
  }
};

/// Largest difference of two predictions, over the largest value of the channel.
inline double difference(const simulation::Prediction& a, const simulation::Prediction& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.channel.size(); ++i) {
    if (a.channel[i].cols() > 0) {
      most = std::max(most, (a.channel[i] - b.channel[i]).cwiseAbs().maxCoeff() /
                                std::max(a.channel[i].cwiseAbs().maxCoeff(), 1e-6));
    }
  }
  return most;
}

/// The same of two machines' predictions for a scene.
inline double difference(const simulation::Machine& one, const simulation::Machine& other,
                         const simulation::Scene& scene) {
  return difference(simulation::predict(one, {scene}).front(),
                    simulation::predict(other, {scene}).front());
}

}  // namespace flexcomp::test
