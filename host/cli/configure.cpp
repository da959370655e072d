#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/command.hpp"
#include "cli/table_file.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "model/robot.hpp"

namespace flexcomp::cli {
namespace {

struct ConfigureOptions {
  std::string model;
  std::string table;
  std::string out;
  double period = 0.004;
};

/// Joint speeds for the plausibility check: a little above what the robot can do.
std::string joint_speeds(const model::Robot& robot) {
  constexpr double kMargin = 1.2;
  std::string text;
  for (const model::JointDynamics& joint : robot.dynamics) {
    text += fmt::format("{}{:.4g}", text.empty() ? "" : ", ", kMargin * joint.velocity);
  }
  return text;
}

std::string configuration(const ConfigureOptions& options, const model::Robot& robot) {
  std::string text = fmt::format(
      "# Configuration of flexcompd for {}.\n"
      "# Every option of flexcompd --help may stand here; those left out have their defaults.\n\n"
      "# fingerprint of {}: geometry, springs, weights\n"
      "model-hash = \"{:016x}\"\n",
      robot.name, options.model, model_hash(robot.elastic));
  if (!options.table.empty()) {
    text += fmt::format("table = \"{}\"\n", std::filesystem::absolute(options.table).string());
  }
  text += fmt::format(
      "\n# s, from one setpoint to the next\n"
      "period = {:.6g}\n\n"
      "# rad/s, a fifth above what the joints can do: faster is implausible\n"
      "joint-speed = [{}]\n",
      options.period, joint_speeds(robot));
  return text;
}

int run(const ConfigureOptions& options) {
  const model::Robot robot = model::load_robot(options.model);
  if (!options.table.empty()) {
    read_table(options.table, robot);
  }
  files::write_file(options.out,
                    [&](std::ostream& stream) { stream << configuration(options, robot); });
  fmt::print("{}: robot {:016x}; start with: flexcompd --config {} --can can0\n", options.out,
             model_hash(robot.elastic), options.out);
  return kDone;
}

}  // namespace

void add_configure(CLI::App* app, Action* action) {
  auto options = std::make_shared<ConfigureOptions>();
  CLI::App* command = app->add_subcommand(
      "configure",
      "A configuration file for flexcompd: the robot's fingerprint, how fast its joints can be, "
      "and\n"
      "the table to start with. Refuses a table of another robot.\n"
      "Example: flexcomp configure --model robot.yaml --table t.fct --out node.toml");
  command->add_option("--model", options->model, "robot.yaml")->required();
  command->add_option("--table", options->table, "made by flexcomp table");
  command->add_option("--period", options->period, "s, from one setpoint to the next")
      ->check(CLI::PositiveNumber);
  command->add_option("--out", options->out, "file to write")->required();
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
