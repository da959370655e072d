#include <fmt/format.h>

#include <limits>
#include <memory>

#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "effects/learned.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "recording/recording.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::cli {
namespace {

struct SimulateOptions {
  RobotChoice model;
  std::string path;
  std::string recording;
  std::string out;
  double compliance_scale = 1;
};

/// Rows of samples, all missing until they are set.
recording::Samples missing(Eigen::Index rows, Eigen::Index columns) {
  return recording::Samples::Constant(rows, columns, std::numeric_limits<double>::quiet_NaN());
}

/// The recording as it would be if the model were right, effects learnt by a diagnosis included.
recording::Recording expected(const model::Robot& robot, const recording::Recording& recording) {
  simulation::Preparation preparation;
  const simulation::Scene scene = simulation::prepare(recording, recording.size(), &preparation);
  const simulation::Prediction prediction =
      simulation::predict(effects::machine_of(robot, {scene}), scene).front();
  recording::Recording shown;
  shown.time = recording.time;
  std::array<recording::Samples, 3> values;
  for (std::size_t channel = 0; channel < values.size(); ++channel) {
    values[channel] = missing(recording.size(), scene.measured[channel].cols());
  }
  for (std::size_t channel = 0; channel < values.size(); ++channel) {
    for (std::size_t at = 0; at < scene.recorded.size() && values[channel].cols() > 0; ++at) {
      values[channel].row(scene.recorded[at]) =
          prediction.channel[channel].row(static_cast<Eigen::Index>(at));
    }
    for (const Eigen::Index row : preparation.repeats) {
      values[channel].row(row) = values[channel].row(row - 1);
    }
  }
  if (scene.has(simulation::tcp_position)) {
    shown.position = values[simulation::tcp_position];
  }
  if (scene.has(simulation::joint_torque)) {
    shown.tau = values[simulation::joint_torque];
  }
  if (scene.has(simulation::joint_deflection)) {
    shown.q_link = values[simulation::joint_deflection] + *recording.q_meas;
  }
  return shown;
}

int run_recording(const SimulateOptions& options) {
  if (options.compliance_scale != 1) {
    throw InputError("--compliance-scale goes with --path, not with --recording");
  }
  const model::Robot robot = load_robot(options.model);
  const recording::Recording shown =
      expected(robot, recording::read_recording(options.recording, robot.joints()));
  recording::write_recording(options.out, shown);
  fmt::print("{}: {} rows\n", options.out, shown.size());
  return kDone;
}

/// Positions of a robot that rests at every row of a path.
recording::Samples resting(const model::Chain& robot, const recording::Recording& path) {
  const recording::Samples& q_cmd = *path.q_cmd;
  const recording::Samples& wrench = *path.wrench;
  recording::Samples position(q_cmd.rows(), 3);
  Progress progress("simulating", static_cast<std::size_t>(q_cmd.rows()));
  for (Eigen::Index row = 0; row < q_cmd.rows(); ++row) {
    try {
      const simulation::Equilibrium at =
          simulation::settle(robot, q_cmd.row(row).transpose(), wrench.row(row).transpose());
      position.row(row) = at.tcp.position.transpose();
    } catch (const simulation::NoRest& error) {
      throw InputError(path.place(row) + ": " + error.what());
    }
    progress.show(static_cast<std::size_t>(row));
  }
  return position;
}

/// Positions of a path that a robot with effects drives, with their history from row to row.
recording::Samples driven(const model::Robot& robot, recording::Recording path) {
  path.q_meas.reset();                                       // the motors follow the command
  path.position = recording::Samples::Zero(path.size(), 3);  // asks for them
  return *expected(robot, path).position;
}

int run_path(const SimulateOptions& options) {
  if (!(options.compliance_scale > 0)) {
    throw InputError("--compliance-scale: expected a number above zero");
  }
  model::Robot robot = load_robot(options.model);
  robot.elastic = simulation::with_scaled_compliance(robot.elastic, options.compliance_scale);
  recording::Recording recording = recording::read_recording_of(robot.elastic, options.path);
  const recording::Samples& q_cmd = recording::require(
      recording, recording.q_cmd, fmt::format("q_cmd_1..q_cmd_{}", robot.joints()));
  recording::require(recording, recording.wrench, "fx..mz");
  const bool has_effects = !robot.effects.empty() || !effects::machine_of(robot).terms.empty();
  recording.position = has_effects ? driven(robot, recording) : resting(robot.elastic, recording);
  recording.q_meas = q_cmd;
  recording::write_recording(options.out, recording);
  fmt::print("{}: {} rows\n", options.out, recording.size());
  return kDone;
}

int run(const SimulateOptions& options) {
  if (options.path.empty() == options.recording.empty()) {
    throw InputError("expected either --path or --recording");
  }
  return options.path.empty() ? run_recording(options) : run_path(options);
}

}  // namespace

void add_simulate(CLI::App* app, Action* action) {
  auto options = std::make_shared<SimulateOptions>();
  CLI::App* command = app->add_subcommand(
      "simulate",
      "With --path, where the robot really goes: its springs bent by the wrench and, with gravity "
      "in\n"
      "the model, by its weight, at rest at every row (quasi-static), and moved by the model's "
      "effects.\n"
      "Effects of a clock, a frame or a sensor show as well, though they move no robot.\n"
      "Writes the rows with q_meas (the motors follow the command) and x, y, z of the TCP; free of "
      "noise.\n"
      "With --recording, what it would show if the model were right, as flexcomp diagnose compares "
      "it:\n"
      "t and, as far as the recording has them, x, y, z, tau and q_link; cells are empty where a "
      "row\n"
      "lacks joint angles or part of the wrench.\n"
      "Example: flexcomp simulate --model robot.yaml --path path.csv --out recording.csv");
  add_robot(command, &options->model)->required();
  command->add_option("--path", options->path, "recording with t, q_cmd and the wrench");
  command->add_option("--recording", options->recording, "recording to simulate once more");
  command->add_option("--out", options->out, "recording to write")->required();
  command->add_option("--compliance-scale", options->compliance_scale,
                      "all springs this many times as soft: a robot that is not as its model says");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
