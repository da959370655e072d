#include "effects/learned_correction.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace flexcomp::effects {
namespace {

constexpr int kSteps = 5;          // of Newton's method, damped
constexpr double kLargest = 0.02;  // rad, of a step: beyond it nothing is linear
constexpr double kDamping = 1e-3;  // m, of the Jacobian's singular values

/// The machine with those effects that move the robot in a way that a command can undo.
Machine moving_machine(const model::Robot& robot, const Scene& scene) {
  model::Robot moving = robot;
  moving.effects.erase(std::remove_if(moving.effects.begin(), moving.effects.end(),
                                      [&](const model::LearnedEffect& learned) {
                                        return !law_of(robot, learned)->traits.can_be_undone;
                                      }),
                       moving.effects.end());
  return machine_of(moving, {scene});
}

/// The program as a recording of a TCP, whose values do not matter.
Scene scene_of(const recording::Recording& program, const recording::Samples& q_cmd) {
  recording::Recording recording;
  recording.file = program.file;
  recording.lines = program.lines;
  recording.time = program.time;
  recording.q_cmd = q_cmd;
  recording.wrench = program.wrench;
  recording.temperature = program.temperature;
  recording.position = recording::Samples::Zero(program.size(), 3);
  simulation::Preparation preparation;
  return simulation::prepare(recording, recording.size(), &preparation);
}

/// Angles that move the TCP by `error` and turn it by nothing.
model::JointValues angles_for(const model::ChainJacobian& jacobian, const Vector3<double>& error) {
  Eigen::Matrix<double, 6, 6> gram = jacobian * jacobian.transpose();
  gram.diagonal().array() += kDamping * kDamping;
  Twist<double> twist = Twist<double>::Zero();
  twist.head<3>() = error;
  model::JointValues angles = jacobian.transpose() * gram.ldlt().solve(twist);
  const double largest = angles.lpNorm<Eigen::Infinity>();
  if (largest > kLargest) {
    angles *= kLargest / largest;
  }
  return angles;
}

}  // namespace

LearnedCorrection correct_for_learned(const model::Robot& robot,
                                      const recording::Recording& program,
                                      const recording::Samples& wanted) {
  LearnedCorrection correction;
  recording::Samples q_cmd = *program.q_cmd;
  const Machine machine = moving_machine(robot, scene_of(program, q_cmd));
  for (int step = 0; step <= kSteps; ++step) {
    const Scene scene = scene_of(program, q_cmd);
    const simulation::Simulation at = simulate(machine, scene);
    const Eigen::MatrixXd errors =
        with_terms(machine.terms, scene, at).channel[simulation::tcp_position] - wanted;
    const double largest = errors.rowwise().norm().maxCoeff();
    if (step == 0) {
      correction.before = largest;
    }
    if (step == 0 || largest < correction.after) {
      correction.after = largest;
      correction.q_cmd = q_cmd;
    }
    if (step == kSteps) {
      break;
    }
    for (Eigen::Index row = 0; row < errors.rows(); ++row) {
      q_cmd.row(row) -=
          angles_for(at.jacobian[static_cast<std::size_t>(row)], errors.row(row).transpose())
              .transpose();
    }
  }
  return correction;
}

}  // namespace flexcomp::effects
