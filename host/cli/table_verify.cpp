#include "cli/table_verify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "cli/process_options.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "cli/table_signing.hpp"
#include "control/path_gain.hpp"
#include "error.hpp"
#include "flexcomp/loop_gain.hpp"
#include "flexcomp/table_builder.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "recording/recording.hpp"

namespace flexcomp::cli {
namespace {

struct VerifyOptions {
  RobotChoice model;
  std::string key;
  std::string table;
  std::string path;
  ProcessOptions process;
  std::size_t samples = 100000;
  bool json = false;
};

using Places = std::function<JointVector<double, 6>(double, std::mt19937_64*)>;

/// Places of the table's own chart: in order along the chords between the nodes of a path, at
/// random in a grid. The first argument runs from 0 to 1.
Places chart_places(const Table& table) {
  return [&table](double along, std::mt19937_64* random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double place[kMaxGridAxes] = {table.chart() == Chart::path ? along : uniform(*random),
                                        uniform(*random), uniform(*random), uniform(*random)};
    return chart_angles<double, 6>(table, place);
  };
}

/// Places of a program, in order.
Places program_places(const recording::Samples& q_cmd) {
  return [&q_cmd](double along, std::mt19937_64* /*random*/) {
    const double row = along * static_cast<double>(q_cmd.rows() - 1);
    const auto from = std::min(static_cast<Eigen::Index>(row), q_cmd.rows() - 2);
    const JointVector<double, 6> start = q_cmd.row(from).transpose();
    const JointVector<double, 6> end = q_cmd.row(from + 1).transpose();
    return JointVector<double, 6>(start + (row - static_cast<double>(from)) * (end - start));
  };
}

TableError<double> largest_error(const model::Robot& robot, const Table& table, std::size_t samples,
                                 const Places& places) {
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  Progress progress("verifying", samples);
  std::mt19937_64 random(20170601);
  std::uniform_real_distribution<double> uniform(0, 1);
  TableCursor cursor;
  TableError<double> worst;
  for (std::size_t i = 0; i < samples; ++i) {
    const double along = (static_cast<double>(i) + uniform(random)) / static_cast<double>(samples);
    const JointVector<double, 6> q = places(along, &random);
    if (look_up<double, 6>(table, q, &cursor).outside > 0) {
      locate<double, 6>(table, q, &cursor);
    }
    const auto error = table_error_at<double, 6>(elastic, table, q, &cursor);
    worst.position = std::max(worst.position, error.position);
    worst.orientation = std::max(worst.orientation, error.orientation);
    progress.show(i);
  }
  return worst;
}

void refuse_what_the_table_does_not_cover(const Table& table, const recording::Recording& path,
                                          const recording::Samples& q_cmd) {
  TableCursor cursor;
  for (Eigen::Index row = 0; row < q_cmd.rows(); ++row) {
    const JointVector<double, 6> q = q_cmd.row(row).transpose();
    locate<double, 6>(table, q, &cursor);
    const double outside = look_up<double, 6>(table, q, &cursor).outside;
    if (outside > 0) {
      throw InputError(fmt::format("{}: lies {:.3g} rad outside the table: it is not for this path",
                                   path.place(row), outside));
    }
  }
}

TableError<double> largest_error(const VerifyOptions& options, const model::Robot& robot,
                                 const Table& table) {
  TableError<double> worst = largest_error(robot, table, options.samples, chart_places(table));
  if (!options.path.empty()) {
    const recording::Recording path = recording::read_program_of(robot.elastic, options.path);
    const recording::Samples& q_cmd = recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6");
    if (q_cmd.rows() < 2) {
      throw InputError(fmt::format("{}: expected two rows or more", options.path));
    }
    refuse_what_the_table_does_not_cover(table, path, q_cmd);
    const TableError<double> on_path =
        largest_error(robot, table, options.samples, program_places(q_cmd));
    worst.position = std::max(worst.position, on_path.position);
    worst.orientation = std::max(worst.orientation, on_path.orientation);
  }
  return worst;
}

/// Result of one part of the check: a line, and whether it can be vouched for.
struct Part {
  bool checked = true;
  bool holds = true;
  std::string text;
};

constexpr const char* kNotChecked =
    "NOT CHECKED: an older flexcomp made the table; give --path, or make it anew\n";

/// The largest gain. One that states its process follows from it, or the table would have been
/// refused; whether the process is yours takes the program.
Part check_gain(const VerifyOptions& options, const model::Robot& robot, const Table& table) {
  const auto stated = static_cast<double>(table.header().largest_gain);
  const GainBasis basis = gain_basis(table.header());
  const std::string name = stated <= 0                  ? std::string("not analysed")
                           : stated <= GainLimit::kNone ? std::string("none is safe")
                                                        : fmt::format("{:.4g}", stated);
  Part gain;
  gain.text = fmt::format("largest safe gain:                {}", name);
  if (options.path.empty()) {
    gain.checked = gain.holds = stated <= 0 || !is_empty(basis);
    gain.text += !gain.checked     ? fmt::format(": {}", kNotChecked)
                 : is_empty(basis) ? "\n"
                                   : fmt::format(", as follows from {}\n", describe(basis));
    return gain;
  }
  const ProcessOptions& process = options.process;
  const double found = process.is_none
                           ? 0
                           : gain_limit(control::feedback_along(
                                            model::six_axis_model(robot),
                                            recording::read_program_of(robot.elastic, options.path),
                                            process.process),
                                        process.loop)
                                 .safe;
  gain.holds = std::abs(stated - found) <= 1e-6 * found;
  gain.text += fmt::format(
      "; found {}{}\n",
      found > 0 ? fmt::format("{:.4g} with {}", found, describe(process)) : "no process",
      gain.holds ? "" : ": NOT THE SAME");
  return gain;
}

/// All joint angles that a tick takes for inside, of which the program is a part.
Part check_inside(const VerifyOptions& options, const Table& table,
                  const Certificate& certificate) {
  Part inside;
  if (table.chart() != Chart::path) {
    return inside;
  }
  inside.checked = certificate.states_inside;
  inside.holds = inside.checked ? certificate.inside_holds : !options.path.empty();
  const InsideError stated = inside_error(table.header());
  inside.text =
      fmt::format("bound at all angles it takes:     {:.4g} µm, {:.4g} µrad",
                  1e6 * certificate.inside.position, 1e6 * certificate.inside.orientation);
  inside.text += inside.checked
                     ? fmt::format("; stated {:.4g} µm, {:.4g} µrad{}\n", 1e6 * stated.position,
                                   1e6 * stated.orientation, inside.holds ? "" : ": DOES NOT HOLD")
                     : fmt::format("; none is stated{}", inside.holds ? "\n" : ": ");
  if (!inside.holds && !inside.checked) {
    inside.text += kNotChecked;
  }
  return inside;
}

/// What the certified bound is worth.
const char* words_of(bool holds, bool is_on_chords, const VerifyOptions& options) {
  if (!holds) {
    return "DOES NOT HOLD";
  }
  return is_on_chords && options.path.empty() ? "holds on the chords between its nodes" : "holds";
}

int run_verify(const VerifyOptions& options) {
  const bool is_signed = !options.key.empty();
  const std::uint32_t version = is_signed ? signed_version(options.table, options.key) : 0;
  const model::Robot robot = load_robot(options.model);
  const TableFile file = read_unproven_table(options.table, robot);
  const Certificate certificate = derive_certificate(options.table, robot, file.table);
  const TableError<double> worst = largest_error(options, robot, file.table);
  const Part gain = check_gain(options, robot, file.table);
  const Part inside = check_inside(options, file.table, certificate);
  const TableHeader& header = file.table.header();
  const bool is_on_chords = file.table.chart() == Chart::path;
  const bool is_certified = certificate.holds && worst.position <= header.position_error &&
                            worst.orientation <= header.orientation_error;
  const bool holds = is_certified && gain.holds && inside.holds;
  if (options.json) {
    nlohmann::ordered_json json = to_json(file.table);
    if (is_signed) {
      json["signed_version"] = version;
    }
    json["samples"] = options.samples;
    json["largest_position_error"] = worst.position;
    json["largest_orientation_error"] = worst.orientation;
    json["derived_position_error"] = certificate.error.position;
    json["derived_orientation_error"] = certificate.error.orientation;
    json["derived_inside_position_error"] = certificate.inside.position;
    json["derived_inside_orientation_error"] = certificate.inside.orientation;
    json["gain_checked"] = gain.checked;
    json["inside_checked"] = inside.checked;
    json["program_checked"] = !options.path.empty();
    json["holds"] = holds;
    fmt::print("{}\n", json.dump(2));
  } else {
    if (is_signed) {
      fmt::print("signed with this key, as version {}\n", version);
    }
    fmt::print(
        "largest error found at {} places{}: {:.4g} µm, {:.4g} µrad\n"
        "bound {} its nodes:    {:.4g} µm, {:.4g} µrad\n"
        "{}{}"
        "certified bound:                  {:.4g} µm, {:.4g} µrad: {}\n",
        options.samples, options.path.empty() ? "" : " and at as many of the program",
        1e6 * worst.position, 1e6 * worst.orientation,
        is_on_chords ? "on the chords between" : "derived from", 1e6 * certificate.error.position,
        1e6 * certificate.error.orientation, inside.text, gain.text, 1e6 * header.position_error,
        1e6 * header.orientation_error, words_of(holds, is_on_chords, options));
  }
  return holds ? kDone : kDoesNotHold;
}

}  // namespace

CLI::App* add_table_verify(CLI::App* table, Action* action) {
  CLI::App* command = table->add_subcommand(
      "verify",
      "Compare a table with the model: its header, the largest gain with the process that it\n"
      "states, and both certificates, derived again from its nodes: at all joint angles that a\n"
      "controller would correct with it, and on the chords between its nodes; then the error at\n"
      "many places. With the path it was made for, on that program itself, and with the process\n"
      "that you give. Exit code 1 if something does not hold, or cannot be checked without the\n"
      "path (of a table by an older flexcomp), 2 if the file is damaged or belongs to another\n"
      "robot.");
  auto options = std::make_shared<VerifyOptions>();
  command->add_option("table", options->table, "table to check")->required();
  add_robot(command, &options->model)->required();
  command->add_option("--key", options->key, "the table must be signed with the key in this file");
  command->add_option("--path", options->path,
                      "look along this program too, besides the chords between the table's nodes");
  add_process(command, &options->process);
  add_loop(command, &options->process.loop);
  command->add_option("--samples", options->samples, "places to look at")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000000}));
  command->add_flag("--json", options->json, "print the result as JSON");
  command->callback([=] { *action = [=] { return run_verify(*options); }; });
  return command;
}

}  // namespace flexcomp::cli
