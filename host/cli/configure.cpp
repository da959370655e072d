#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <tuple>

#include "cli/command.hpp"
#include "cli/frame_option.hpp"
#include "cli/number_options.hpp"
#include "cli/output_folder.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "control/path_gain.hpp"
#include "controller/kuka_axes.hpp"
#include "controller/rsi_files.hpp"
#include "controller/sensor_lines.hpp"
#include "effects/beyond_tables.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "flexcomp/loop_gain.hpp"
#include "model/c_model.hpp"
#include "model/robot.hpp"

namespace flexcomp::cli {
namespace {

struct ConfigureOptions {
  RobotChoice model;
  std::string table;
  std::string out;
  std::string c_model;
  double period = 0.004;
  std::string rsi_folder;
  std::string rsi_address = "192.168.1.10:49152";
  bool rsi_relative = false;
  bool rsi_force = false;
  double rsi_limit = 1.0;
  std::string sensor;
  std::vector<double> sensor_frame;
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

/// "ADDRESS:PORT" in numbers, as the controller's files and flexcompd's want it.
std::pair<std::string, std::uint16_t> address_of(const std::string& option,
                                                 const std::string& text) {
  const std::size_t colon = text.rfind(':');
  const std::string host = text.substr(0, colon);
  std::uint16_t port = 0;
  in_addr ignored{};
  const bool has_port =
      colon != std::string::npos && CLI::detail::lexical_cast(text.substr(colon + 1), port);
  if (!has_port || port == 0 || inet_pton(AF_INET, host.c_str(), &ignored) != 1) {
    throw InputError(option + " " + text + ": expected ADDRESS:PORT in numbers");
  }
  return {host, port};
}

controller::RsiProject rsi_project(const ConfigureOptions& options, const model::Robot& robot) {
  controller::RsiProject project;
  project.robot = robot.name;
  std::tie(project.address, project.port) = address_of("--rsi-address", options.rsi_address);
  const std::uint64_t hash = model_hash(model::six_axis_model(robot));
  project.type = fmt::format("flexcomp_{:08x}", static_cast<std::uint32_t>(hash ^ hash >> 32U));
  project.mode = options.rsi_relative ? RsiMode::relative : RsiMode::absolute;
  project.period = options.period;
  project.largest = options.rsi_limit;
  project.has_force = options.rsi_force;
  return project;
}

/// The part of flexcompd's configuration that fits the controller's files.
std::string rsi_configuration(const ConfigureOptions& options,
                              const controller::RsiProject& project, const model::Robot& robot) {
  const std::optional<AxisConvention> axes = controller::kuka_axes(model::six_axis_model(robot));
  std::string text = fmt::format(
      "\n# the controller's RSI, as in flexcomp.xml, flexcomp.rsi.xml and flexcomp.src\n"
      "rsi = \"udp://{}:{}\"\nrsi-mode = \"{}\"\nrsi-type = \"{}\"\n"
      "rsi-arm = \"{}\"\nrsi-applied = \"{}\"\nrsi-state = \"{}\"\nrsi-limit = {:g}\n",
      project.address, project.port, project.mode == RsiMode::absolute ? "absolute" : "relative",
      project.type, controller::kRsiArmed, controller::kRsiApplied, controller::kRsiState,
      project.largest);
  text +=
      axes ? "\n# KUKA's axes against the joints of the URDF, from its geometry; those of A1, A4 "
             "and A6 at zero are taken to agree\n"
           : "\n# the URDF is not built as a KUKA: say how the controller counts its axes\n";
  text += fmt::format("{0}rsi-sign = [{1}]\n{0}rsi-zero = [{2}]\n", axes ? "" : "# ",
                      controller::list_of(axes.value_or(AxisConvention()).sign),
                      controller::list_of(axes.value_or(AxisConvention()).zero));
  text += project.has_force ? fmt::format(
                                  "\n# all comes over RSI: rsi-type says which robot it is\n"
                                  "rsi-wrench = \"{}\"\nwithout-identity = true\n",
                                  controller::kRsiWrench)
          : options.sensor.empty()
              ? "\n# the wrench comes over CAN or LCM: start flexcompd with --can or --lcm too\n"
              : "\n# rsi-type says which robot it is\nwithout-identity = true\n";
  return text;
}

/// The files to write: flexcompd's, and those of the controller where they are asked for.
std::vector<std::pair<std::filesystem::path, std::string>> files_of(const ConfigureOptions& options,
                                                                    const model::Robot& robot,
                                                                    double largest_gain) {
  std::string text = configuration(options, robot, largest_gain);
  std::vector<std::pair<std::filesystem::path, std::string>> all;
  if (!options.rsi_folder.empty()) {
    const controller::RsiProject project = rsi_project(options, robot);
    text += rsi_configuration(options, project, robot);
    const std::filesystem::path folder = output_folder(options.rsi_folder);
    for (auto& [name, contents] : controller::rsi_files(project)) {
      all.emplace_back(folder / name, std::move(contents));
    }
  }
  if (!options.sensor.empty()) {
    address_of("--sensor", options.sensor);
    const auto frame = frame_of(options.sensor_frame, "--sensor-frame");
    text += controller::sensor_lines(options.sensor, frame.value_or(Pose<double>()), robot);
  }
  if (!options.c_model.empty()) {
    all.emplace_back(options.c_model, model::c_model_text(robot));
  }
  all.emplace_back(options.out, std::move(text));
  return all;
}

int run(const ConfigureOptions& options) {
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  double largest_gain = 0;
  if (!options.table.empty()) {
    const TableFile file = read_table(options.table, robot);
    const TableHeader& header = file.table.header();
    largest_gain = control::largest_gain_in(header, options.period,
                                            static_cast<double>(gain_basis(header).filter_cutoff));
  }
  if (largest_gain > 0 && largest_gain <= 1.01 * GainLimit::kNone) {
    fmt::print(
        stderr,
        "flexcomp: {}: no gain is safe with the process it was made for and a period of {:g} s: "
        "make it with the depth of your cut (flexcomp table --depth-of-cut) and its side "
        "(--material), or for less force; nothing is written\n",
        options.table, options.period);
    return kDoesNotHold;
  }
  const std::string lacking = effects::warning_beyond_tables(robot);
  files::write_texts(files_of(options, robot, largest_gain));
  if (!lacking.empty()) {
    fmt::print(stderr, "flexcomp: {}\n", lacking);
  }
  const bool needs_bus =
      options.rsi_folder.empty() || !(options.rsi_force || !options.sensor.empty());
  fmt::print("{}: robot {:016x}; start with: flexcompd --config {}{}\n", options.out,
             model_hash(elastic), options.out, needs_bus ? " --can can0" : "");
  if (!options.c_model.empty()) {
    fmt::print("{}: the robot for a program in C\n", options.c_model);
  }
  if (!options.rsi_folder.empty()) {
    fmt::print("{}: flexcomp.xml, flexcomp.rsi.xml and flexcomp.src for the controller (RSI.md)\n",
               options.rsi_folder);
  }
  if (!options.table.empty() && largest_gain <= 0) {
    fmt::print("the largest safe gain is not known: the table was made without a process\n");
  } else if (!options.table.empty()) {
    fmt::print(
        "gain {}, the largest that is safe with the process the table was made for, every {:g} s\n",
        gain_text(safe_gain(largest_gain)), options.period);
  }
  return kDone;
}

void add_rsi_files(CLI::App* command, ConfigureOptions* options) {
  CLI::Option* folder = command->add_option(
      "--rsi", options->rsi_folder,
      "folder for the files that a KUKA needs for RSI: its Ethernet configuration, its context and "
      "a\nKRL program that starts it");
  command
      ->add_option("--rsi-address", options->rsi_address,
                   "ADDRESS:PORT of flexcompd's computer on the controller's sensor network")
      ->needs(folder);
  command
      ->add_flag("--rsi-relative", options->rsi_relative,
                 "corrections are what is added each cycle, not the whole")
      ->needs(folder);
  command
      ->add_flag("--rsi-force", options->rsi_force,
                 "the wrench is in the telegram, from a sensor wired into the context")
      ->needs(folder);
  command->add_option("--rsi-limit", options->rsi_limit, "degrees, largest correction of an axis")
      ->check(CLI::Range(1e-3, 5.0))
      ->needs(folder);
}

void add_sensor(CLI::App* command, ConfigureOptions* options) {
  CLI::Option* address = command->add_option(
      "--sensor", options->sensor,
      "ADDRESS:PORT of a force sensor of ATI that flexcompd takes the wrench from (SENSOR.md)");
  address->excludes("--rsi-force");
  add_frame(command, "--sensor-frame", "the sensor's frame in that of the robot's tool link",
            &options->sensor_frame)
      ->needs(address);
}

}  // namespace

void add_configure(CLI::App* app, Action* action) {
  auto options = std::make_shared<ConfigureOptions>();
  CLI::App* command = app->add_subcommand(
      "configure",
      "A configuration file for flexcompd: the robot's fingerprint, how fast its joints can be, "
      "and\n"
      "the table to start with, with the largest gain that is safe for it. Refuses a table of "
      "another robot. With --rsi also the files for the controller of a KUKA.\n"
      "Example: flexcomp configure --model robot.yaml --table t.fct --out node.toml");
  add_robot(command, &options->model)->required();
  command->add_option("--table", options->table, "made by flexcomp table");
  command->add_option("--period", options->period, "s, from one setpoint to the next")
      ->check(above_zero());
  command->add_option("--out", options->out, "file to write")->required();
  command->add_option("--c-model", options->c_model,
                      "header to write too: the robot as flexcomp_model_t, for a program in C");
  add_rsi_files(command, options.get());
  add_sensor(command, options.get());
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
