#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "effects/learned_correction.hpp"
#include "error.hpp"
#include "flexcomp/compensator.hpp"
#include "flexcomp/table_builder.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "recording/recording.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::cli {
namespace {

using Core = Compensator<double, 6>;

struct CompensateOptions {
  RobotChoice model;
  std::string table;
  std::string path;
  std::string out;
  bool json = false;
};

/// The gain that the core takes with a table. A program that is corrected beforehand closes no loop
/// through the process, so what a table allows a controller does not matter: the correction is
/// linear in the gain, and is divided by it afterwards.
double offline_gain(const Table& table) {
  const auto largest = static_cast<double>(table.header().largest_gain);
  return largest > 0 ? std::min(largest, 1.0) : 1.0;
}

/// The core as an offline tool: no filter, no fading, and limits that only a fault would meet, so
/// that every row gets its full correction.
Core::Config offline_config(const model::Robot& robot, const Table& table) {
  Core::Config config;
  config.period = 1;
  config.model_hash = model_hash(model::six_axis_model(robot));
  config.gain = offline_gain(table);
  // The certificate holds up to these; rounding to float in the header may have shaved a bit off.
  config.force_range = 1.000001 * table.header().force_bound + 1e-6;
  config.moment_range = 1.000001 * table.header().moment_bound + 1e-6;
  config.setpoint_age_limit = 1;
  config.wrench_age_limit = 1;
  config.joint_speed.setConstant(1e6);
  config.limits.fill({0.2 * config.gain, 1e3, 1e3});
  config.deflection_limit = 0.1 * config.gain;
  // The program may be sampled anew between the points the table was made from.
  config.chart_margin = 1e-3;
  config.hold_time = 0;
  config.fade_time = 0;
  config.ready_ticks = 1;
  return config;
}

/// Runs the program through the core, tick by tick.
class OfflineCompensator {
 public:
  OfflineCompensator(const model::Robot& robot, const Table& table,
                     const recording::Recording& path)
      : path_(path),
        nodes_(table.header().node_count),
        gain_(offline_gain(table)),
        q_cmd_(recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6")),
        wrench_(recording::require(path, path.wrench, "fx..mz")) {
    Result result = core_.configure(offline_config(robot, table));
    if (result == Result::ok) {
      result = core_.set_table(table);
    }
    if (result != Result::ok) {
      throw InputError(fmt::format("the table cannot be used: {}", describe(result)));
    }
    tick(0);
    if (core_.arm() != Result::ok) {
      refuse(0, tick(0).status);
    }
  }

  JointVector<double, 6> corrected(Eigen::Index row) {
    Core::Output output = tick(row);
    // Where the program has run back on itself and turns off, the core looks for the new segment
    // over a few ticks; here there is time for that.
    for (std::uint32_t i = 0; i < nodes_ && (output.status & kChartEdge) != 0; ++i) {
      output = tick(row);
    }
    if (output.status != 0 || output.state != State::active) {
      refuse(row, output.status);
    }
    return q_cmd_.row(row).transpose() + output.correction / gain_;
  }

 private:
  Core::Output tick(Eigen::Index row) {
    return core_.tick({q_cmd_.row(row).transpose(), 0, wrench_.row(row).transpose(), 0, false});
  }

  [[noreturn]] void refuse(Eigen::Index row, std::uint32_t status) const {
    std::string reasons;
    for (std::uint32_t bit = 1; bit != 0 && bit <= kNoSetpoint; bit <<= 1) {
      if ((status & bit) != 0) {
        reasons +=
            (reasons.empty() ? "" : ", ") + std::string(describe(static_cast<StatusBit>(bit)));
      }
    }
    throw InputError(fmt::format("{}: {}; make the table from this path, for its largest wrench",
                                 path_.place(row), reasons));
  }

  const recording::Recording& path_;
  std::uint32_t nodes_;
  double gain_;
  const recording::Samples& q_cmd_;
  const recording::Samples& wrench_;
  Core core_;
};

/// Distance of the bent TCP from where it should be.
TableError<double> tcp_error(const model::Chain& model, const JointVector<double, 6>& wanted,
                             const JointVector<double, 6>& commanded,
                             const Wrench<double>& wrench) {
  const Twist<double> off = pose_difference(forward_kinematics(model, wanted).tcp,
                                            simulation::settle(model, commanded, wrench).tcp);
  return {off.head<3>().norm(), off.tail<3>().norm()};
}

/// Where the TCP of the stiff robot would pass: n×3, m.
recording::Samples wanted_positions(const model::Robot& robot, const recording::Samples& q_cmd) {
  recording::Samples wanted(q_cmd.rows(), 3);
  for (Eigen::Index row = 0; row < q_cmd.rows(); ++row) {
    wanted.row(row) =
        forward_kinematics(robot.elastic, q_cmd.row(row).transpose()).tcp.position.transpose();
  }
  return wanted;
}

int run(const CompensateOptions& options) {
  const model::Robot robot = load_robot(options.model);
  const TableFile file = read_table(options.table, robot);
  const recording::Recording path = recording::read_program_of(robot.elastic, options.path);
  OfflineCompensator compensator(robot, file.table, path);

  recording::Recording corrected = path;
  TableError<double> before;
  TableError<double> after;
  Progress progress("compensating", static_cast<std::size_t>(path.size()));
  for (Eigen::Index row = 0; row < path.size(); ++row) {
    const JointVector<double, 6> wanted = path.q_cmd->row(row).transpose();
    const Wrench<double> wrench = path.wrench->row(row).transpose();
    const JointVector<double, 6> command = compensator.corrected(row);
    corrected.q_cmd->row(row) = command.transpose();
    const auto larger = [](TableError<double>* worst, const TableError<double>& error) {
      worst->position = std::max(worst->position, error.position);
      worst->orientation = std::max(worst->orientation, error.orientation);
    };
    larger(&before, tcp_error(robot.elastic, wanted, wanted, wrench));
    larger(&after, tcp_error(robot.elastic, wanted, command, wrench));
    progress.show(static_cast<std::size_t>(row));
  }
  std::optional<effects::LearnedCorrection> learned;
  if (!robot.effects.empty()) {
    learned = effects::correct_for_learned(robot, corrected, wanted_positions(robot, *path.q_cmd));
    corrected.q_cmd = learned->q_cmd;
  }
  recording::write_recording(options.out, corrected);
  if (options.json) {
    nlohmann::ordered_json json = {
        {"rows", path.size()},
        {"before", {{"position", before.position}, {"orientation", before.orientation}}},
        {"after", {{"position", after.position}, {"orientation", after.orientation}}}};
    if (learned) {
      json["learned"] = {{"before", learned->before}, {"after", learned->after}};
    }
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print(
        "{}: {} rows\nlargest error of the model's TCP: {:.4g} mm, {:.4g} mrad before; {:.3g} mm, "
        "{:.3g} mrad after\n",
        options.out, path.size(), 1e3 * before.position, 1e3 * before.orientation,
        1e3 * after.position, 1e3 * after.orientation);
    if (learned) {
      fmt::print("with the effects learnt of it: {:.4g} mm so far; {:.3g} mm corrected for them\n",
                 1e3 * learned->before, 1e3 * learned->after);
    }
  }
  return kDone;
}

}  // namespace

void add_compensate(CLI::App* app, Action* action) {
  auto options = std::make_shared<CompensateOptions>();
  CLI::App* command = app->add_subcommand(
      "compensate",
      "Correct a program: the same rows, with q_cmd moved so that the TCP of the bent robot "
      "stands,\n"
      "in position and orientation, where the given q_cmd would put that of a stiff one. Runs the\n"
      "controller's own core, tick by tick, without filter and fading. Of a model from a "
      "diagnosis,\n"
      "the effects under its key 'effects', which the core does not know, are corrected too, with\n"
      "the wrench as the force sensor reads it.\n"
      "Example: flexcomp compensate --model robot.yaml --table t.fct --path path.csv --out "
      "out.csv");
  add_robot(command, &options->model)->required();
  command->add_option("--table", options->table, "made by flexcomp table")->required();
  command->add_option("--path", options->path, "recording with t, q_cmd and the wrench")
      ->required();
  command->add_option("--out", options->out, "recording to write")->required();
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
