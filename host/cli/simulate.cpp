#include <fmt/format.h>

#include <memory>

#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "recording/recording.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::cli {
namespace {

struct Options {
  std::string model;
  std::string path;
  std::string out;
  double compliance_scale = 1;
};

int run(const Options& options) {
  if (!(options.compliance_scale > 0)) {
    throw InputError("--compliance-scale: expected a number above zero");
  }
  const model::Robot robot = model::load_robot(options.model);
  const RobotModel<double, 6> plant =
      simulation::with_scaled_compliance(robot.elastic, options.compliance_scale);
  recording::Recording recording = recording::read_recording(options.path);
  const recording::Samples& q_cmd =
      recording::require(recording, recording.q_cmd, "q_cmd_1..q_cmd_6");
  const recording::Samples& wrench = recording::require(recording, recording.wrench, "fx..mz");
  recording::Samples position(recording.size(), 3);
  Progress progress("simulating", static_cast<std::size_t>(recording.size()));
  for (Eigen::Index row = 0; row < recording.size(); ++row) {
    const simulation::Equilibrium at =
        simulation::settle(plant, q_cmd.row(row).transpose(), wrench.row(row).transpose());
    position.row(row) = at.tcp.position.transpose();
    progress.show(static_cast<std::size_t>(row));
  }
  recording.q_meas = q_cmd;
  recording.position = position;
  recording::write_recording(options.out, recording);
  return kDone;
}

}  // namespace

void add_simulate(CLI::App* app, Action* action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app->add_subcommand(
      "simulate",
      "Where the robot really goes: its springs bent by the wrench and, with gravity in the model, "
      "by\n"
      "its weight, at rest at every row (quasi-static). Writes the rows with q_meas (the motors "
      "follow\n"
      "the command) and x, y, z of the TCP; free of noise.\n"
      "Example: flexcomp simulate --model robot.yaml --path path.csv --out recording.csv");
  command->add_option("--model", options->model, "robot.yaml")->required();
  command->add_option("--path", options->path, "recording with t, q_cmd and the wrench")
      ->required();
  command->add_option("--out", options->out, "recording to write")->required();
  command->add_option("--compliance-scale", options->compliance_scale,
                      "all springs this many times as soft: a robot that is not as its model says");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
