#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "cli/command.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "flexcomp/loop_gain.hpp"
#include "model/robot.hpp"

namespace flexcomp::cli {
namespace {

struct ConfigureOptions {
  RobotChoice model;
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

/// Rounded down to four digits, so that it is never above the limit it comes from.
std::string gain_text(double gain) {
  const double unit = std::pow(10, std::floor(std::log10(gain)) - 3);
  return fmt::format("{:.4g}", std::floor(gain / unit) * unit);
}

/// The gain to write: the table's largest safe one, or 1 where that was not analysed.
double safe_gain(double largest) { return largest > 0 ? std::min(largest, 1.0) : 1; }

std::string configuration(const ConfigureOptions& options, const model::Robot& robot,
                          double largest_gain) {
  std::string text = fmt::format(
      "# Configuration of flexcompd for {}.\n"
      "# Every option of flexcompd --help may stand here; those left out have their defaults.\n\n"
      "# fingerprint of {}: geometry, springs, weights\n"
      "model-hash = \"{:016x}\"\n",
      robot.name, options.model.file, model_hash(model::six_axis_model(robot)));
  if (!options.table.empty()) {
    text += fmt::format("table = \"{}\"\n", std::filesystem::absolute(options.table).string());
  }
  if (!options.table.empty()) {
    text += fmt::format(
        "\n# share of the deflection that is corrected: {}\ngain = {}\n",
        largest_gain > 0 ? "the largest that the table's process allows" : "process not analysed",
        gain_text(safe_gain(largest_gain)));
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
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  double largest_gain = 0;
  if (!options.table.empty()) {
    largest_gain =
        static_cast<double>(read_table(options.table, robot).table.header().largest_gain);
  }
  if (largest_gain > 0 && largest_gain <= 1.01 * GainLimit::kNone) {
    fmt::print(
        stderr,
        "flexcomp: {}: no gain is safe with the process it was made for: it takes a deeper cut "
        "(flexcomp table --depth-of-cut) or less force; nothing is written\n",
        options.table);
    return kDoesNotHold;
  }
  files::write_file(options.out, [&](std::ostream& stream) {
    stream << configuration(options, robot, largest_gain);
  });
  fmt::print("{}: robot {:016x}; start with: flexcompd --config {} --can can0\n", options.out,
             model_hash(elastic), options.out);
  if (!options.table.empty() && largest_gain <= 0) {
    fmt::print("the largest safe gain is not known: the table was made without a process\n");
  } else if (!options.table.empty()) {
    fmt::print("gain {}, the largest that is safe with the process the table was made for\n",
               gain_text(safe_gain(largest_gain)));
  }
  return kDone;
}

}  // namespace

void add_configure(CLI::App* app, Action* action) {
  auto options = std::make_shared<ConfigureOptions>();
  CLI::App* command = app->add_subcommand(
      "configure",
      "A configuration file for flexcompd: the robot's fingerprint, how fast its joints can be, "
      "and\n"
      "the table to start with, with the largest gain that is safe for it. Refuses a table of "
      "another robot.\n"
      "Example: flexcomp configure --model robot.yaml --table t.fct --out node.toml");
  add_robot(command, &options->model)->required();
  command->add_option("--table", options->table, "made by flexcomp table");
  command->add_option("--period", options->period, "s, from one setpoint to the next")
      ->check(CLI::PositiveNumber);
  command->add_option("--out", options->out, "file to write")->required();
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
