#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/help.hpp"
#include "cli/number_options.hpp"
#include "cli/process_options.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "cli/table_signing.hpp"
#include "cli/table_verify.hpp"
#include "control/path_gain.hpp"
#include "effects/beyond_tables.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "flexcomp/table_builder.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "recording/recording.hpp"

namespace flexcomp::cli {
namespace {

struct BuildOptions {
  RobotChoice model;
  std::string path;
  std::string out;
  double tolerance = 1e-6;
  double orientation_tolerance = 0;
  double force = 0;
  double moment = 0;
  ProcessOptions process;
  SigningOptions signing;
  bool json = false;
};

/// Requirements of the table; where wrench bounds are not given, they are a tenth above the path's.
TableRequirements<double> requirements(const BuildOptions& options,
                                       const recording::Recording& path) {
  TableRequirements<double> wanted{
      options.force, options.moment, options.tolerance,
      options.orientation_tolerance > 0 ? options.orientation_tolerance : options.tolerance};
  const recording::Samples& wrench = recording::require(path, path.wrench, "fx..mz");
  const double force = wrench.leftCols<3>().rowwise().norm().maxCoeff();
  const double moment = wrench.rightCols<3>().rowwise().norm().maxCoeff();
  wanted.force_bound = options.force > 0 ? options.force : 1.1 * force;
  wanted.moment_bound = options.moment > 0 ? options.moment : 1.1 * moment;
  if (wanted.force_bound + wanted.moment_bound <= 0) {
    wanted.force_bound = 1;  // a path without load: only weight can act
  }
  return wanted;
}

/// Builds into a buffer that grows until the table fits.
std::vector<std::uint32_t> build(const RobotModel<double, 6>& model,
                                 const std::vector<JointVector<double, 6>>& points,
                                 const TableRequirements<double>& wanted) {
  constexpr std::size_t kLargest = std::size_t{1} << 30;
  for (std::size_t capacity = std::size_t{1} << 20;; capacity *= 4) {
    std::vector<std::uint32_t> words(capacity / 4);
    std::size_t size = 0;
    const Result built = build_path_table<double, 6>(model, points.data(), points.size(), wanted,
                                                     words.data(), capacity, &size);
    if (built == Result::ok) {
      words.resize(size / 4);
      return words;
    }
    if (built != Result::buffer_too_small || capacity >= kLargest) {
      throw InputError(fmt::format("no table: {}", describe(built)));
    }
  }
}

std::string gain_text(const GainLimit& gain, const ProcessOptions& process) {
  if (process.is_none) {
    return "no process: the largest safe correction gain is not analysed";
  }
  if (gain.digs_in()) {
    return fmt::format(
        "no stable correction gain is safe with {}: {}\nA controller refuses this table; programs "
        "can be corrected with it (compensate)",
        describe(process), describe_digging_in(gain));
  }
  const std::string text =
      fmt::format("largest safe correction gain {:.4g}, with {}", gain.safe, describe(process));
  return gain.engagement_without <= GainLimit::kMargin ? text : text + "\n" + describe_fading(gain);
}

int run_build(const BuildOptions& options) {
  if (!(options.tolerance > 0)) {
    throw InputError("--tolerance: expected a length above zero");
  }
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  const recording::Recording path = recording::read_program_of(robot.elastic, options.path);
  const recording::Samples& q_cmd = recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6");
  std::vector<JointVector<double, 6>> points;
  for (Eigen::Index row = 0; row < q_cmd.rows(); ++row) {
    points.emplace_back(q_cmd.row(row).transpose());
  }
  std::vector<std::uint32_t> words;
  TableRequirements<double> wanted = requirements(options, path);
  GainLimit gain;
  if (!options.process.is_none) {
    wanted.gain_basis =
        control::gain_basis(control::feedback_along(elastic, path, options.process.process),
                            options.process.process, options.process.loop);
    gain = gain_limit(wanted.gain_basis);
    wanted.largest_gain = gain.safe;
  }
  try {
    words = build(elastic, points, wanted);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", options.path, error.what()));
  }
  const std::string bytes(reinterpret_cast<const char*>(words.data()),
                          words.size() * sizeof(std::uint32_t));
  const std::string lacking = effects::warning_beyond_tables(robot);
  files::write_text(options.out, bytes + trailer_for(bytes, options.signing));
  if (!lacking.empty()) {
    fmt::print(stderr, "flexcomp: {}\n", lacking);
  }
  Table table;
  Table::open(words.data(), 4 * words.size(), &table);
  if (options.json) {
    nlohmann::ordered_json json = to_json(table);
    json["process"] = to_json(options.process);
    fmt::print("{}\n", json.dump(2));
  } else {
    const TableHeader& header = table.header();
    const InsideError inside = inside_error(header);
    fmt::print(
        "{}: {} nodes, {} bytes\ncertified: no deflection or corrected position is off by more "
        "than {:.3g} µm and {:.3g} µrad,\nat angles off the program that it takes too {:.3g} µm "
        "and {:.3g} µrad,\nfor any force up to {:.6g} N and moment up to {:.6g} N·m\n",
        options.out, header.node_count, header.size, 1e6 * header.position_error,
        1e6 * header.orientation_error, 1e6 * inside.position, 1e6 * inside.orientation,
        header.force_bound, header.moment_bound);
    fmt::print("{}\n", gain_text(gain, options.process));
  }
  return kDone;
}

}  // namespace

void add_table(CLI::App* app, Action* action) {
  CLI::App* command = app->add_subcommand(
      "table",
      "The robot's compliance along a program, for the controller, with a certified error, and "
      "the\n"
      "largest correction gain that is safe: moving deeper into a cut raises the force, which "
      "past\n"
      "that gain helps less than it harms. A controller refuses more.\n"
      "Example: flexcomp table --model robot.yaml --path path.csv --tolerance 1e-6 --out t.fct\n"
      "         flexcomp table verify t.fct --model robot.yaml\n"
      "         flexcomp table sign t.fct --key key --counter 7");
  auto build = std::make_shared<BuildOptions>();
  command->require_subcommand(0, 1);
  CLI::Option* model = add_robot(command, &build->model);
  CLI::Option* path =
      command->add_option("--path", build->path, "recording with t, q_cmd and the wrench");
  CLI::Option* out = command->add_option("--out", build->out, "table to write");
  command->add_option("--tolerance", build->tolerance, "m, largest allowed error at the TCP");
  command
      ->add_option("--orientation-tolerance", build->orientation_tolerance,
                   "rad; if not given, the number of --tolerance")
      ->check(above_zero())
      ->default_str("");
  command
      ->add_option("--force", build->force,
                   "N, largest force to certify for; if not given, 1.1 times the path's")
      ->check(above_zero())
      ->default_str("");
  command
      ->add_option("--moment", build->moment,
                   "N·m, largest moment to certify for; if not given, 1.1 times the path's")
      ->check(above_zero())
      ->default_str("");
  add_process(command, &build->process);
  add_loop(command, &build->process.loop);
  add_signing(command, &build->signing);
  command->add_flag("--json", build->json, "print the certificate as JSON");

  CLI::App* check = add_table_verify(command, action);
  CLI::App* sign = add_table_sign(command, action);
  require_without_subcommand(command, {model, path, out});

  command->callback([=] {
    if (check->parsed() || sign->parsed()) {
      return;
    }
    *action = [=] { return run_build(*build); };
  });
}

}  // namespace flexcomp::cli
