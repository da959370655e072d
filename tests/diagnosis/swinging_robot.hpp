#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "diagnosis/observations.hpp"
#include "effects/learned.hpp"
#include "model/robot.hpp"
#include "simulation/scene.hpp"

namespace flexcomp::test {

constexpr double kTcpNoise = 1e-5;  ///< m

/// An unloaded KR 270 whose first five joints swing for 40 s at 100 Hz, each at a rhythm of its
/// own, or so that the whole motion repeats every 5 s, while the sixth stands; its TCP is measured
/// with noise.
struct SwingingRobot {
  model::Robot robot;
  recording::Recording recording;
  simulation::Scene scene;    ///< of what is predicted
  Eigen::MatrixXd predicted;  ///< n×3, m

  explicit SwingingRobot(unsigned seed, bool repeats = false)
      : robot(model::load_robot(FLEXCOMP_ROBOTS "/kr270/robot.yaml")) {
    constexpr Eigen::Index kRows = 4000;
    constexpr double kMiddle[] = {0, -1.2, 1.4, 0.3, 0.6, 0.1};
    constexpr double kSwing[] = {0.3, 0.2, 0.2, 0.4, 0.4, 0};
    constexpr double kRhythm[] = {0.131, 0.173, 0.212, 0.247, 0.293, 0};  // Hz
    robot.elastic.gravity.setZero();
    recording.file = "swinging.csv";
    recording.time = Eigen::VectorXd::LinSpaced(kRows, 0, 0.01 * (kRows - 1));
    recording::Samples q(kRows, 6);
    for (Eigen::Index joint = 0; joint < 6; ++joint) {
      constexpr double kOften = 0.2;  // Hz
      const double rhythm = repeats ? kOften * std::ceil(kRhythm[joint] / kOften) : kRhythm[joint];
      const double omega = 2 * std::acos(-1.0) * rhythm;
      q.col(joint) =
          kMiddle[joint] +
          kSwing[joint] * (omega * recording.time.array() + 0.7 * static_cast<double>(joint)).sin();
    }
    recording.q_meas = q;
    recording.position = recording::Samples::Zero(kRows, 3);
    simulation::Preparation preparation;
    scene = simulation::prepare(recording, kRows, &preparation);
    const simulation::Machine machine = effects::machine_of(robot, {scene});
    predicted = simulation::simulate(machine, scene).prediction.channel[simulation::tcp_position];
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, kTcpNoise);
    for (Eigen::Index row = 0; row < kRows; ++row) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        (*recording.position)(row, axis) = predicted(row, axis) + noise(random);
      }
    }
  }

  Eigen::Index rows() const { return recording.size(); }

  /// By how much the TCP moves for small errors of one joint's angle (n, rad), by a difference.
  Eigen::MatrixXd moved_by(int joint, const Eigen::VectorXd& error) const {
    constexpr double kStep = 1e-6;
    simulation::Scene turned = scene;
    turned.q.col(joint - 1).array() += kStep;
    const simulation::Machine machine = effects::machine_of(robot, {scene});
    const Eigen::MatrixXd other =
        simulation::simulate(machine, turned).prediction.channel[simulation::tcp_position];
    return error.asDiagonal() * ((other - predicted) / kStep);
  }

  /// Observations where the TCP is elsewhere by an error (n×3, m).
  diagnosis::Observations observed(const Eigen::MatrixXd& error) const {
    recording::Recording shown = recording;
    *shown.position += error;
    simulation::Preparation preparation;
    std::vector<simulation::Scene> scenes = {simulation::prepare(shown, rows(), &preparation)};
    simulation::Machine machine = effects::machine_of(robot, scenes);
    return diagnosis::Observations(std::move(machine), std::move(scenes), 0);
  }

  diagnosis::Observations observed() const { return observed(Eigen::MatrixXd::Zero(rows(), 3)); }
};

}  // namespace flexcomp::test
