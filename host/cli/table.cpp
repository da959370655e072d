#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "cli/command.hpp"
#include "cli/process_options.hpp"
#include "cli/progress.hpp"
#include "cli/table_file.hpp"
#include "cli/table_signing.hpp"
#include "control/path_gain.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "flexcomp/table_builder.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "recording/recording.hpp"

namespace flexcomp::cli {
namespace {

struct BuildOptions {
  std::string model;
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

struct VerifyOptions {
  std::string model;
  std::string key;
  std::string table;
  std::string path;
  ProcessOptions process;
  std::size_t samples = 100000;
  bool json = false;
};

/// What is asked of the table; where the wrench bounds are not given, a tenth above the path's.
TableRequirements<double> requirements(const BuildOptions& options,
                                       const recording::Recording& path) {
  TableRequirements<double> wanted{
      options.force, options.moment, options.tolerance,
      options.orientation_tolerance > 0 ? options.orientation_tolerance : options.tolerance, 0};
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

nlohmann::ordered_json summary(const Table& table) {
  const TableHeader& header = table.header();
  return {{"chart", table.chart() == Chart::path ? "path" : "joint_grid"},
          {"nodes", header.node_count},
          {"bytes", header.size},
          {"model_hash", fmt::format("{:016x}", table.model_hash())},
          {"force_bound", header.force_bound},
          {"moment_bound", header.moment_bound},
          {"certified_position_error", header.position_error},
          {"certified_orientation_error", header.orientation_error},
          {"largest_gain", header.largest_gain}};
}

std::string gain_text(const control::GainLimit& gain, const ProcessOptions& process) {
  if (process.is_none) {
    return "no process: the largest safe correction gain is not analysed";
  }
  if (gain.digs_in()) {
    return fmt::format("no stable correction gain is safe with {}: {}", describe(process),
                       describe_digging_in(gain));
  }
  const std::string text =
      fmt::format("largest safe correction gain {:.4g}, with {}", gain.safe, describe(process));
  return gain.engagement_without <= control::GainLimit::kMargin
             ? text
             : text + "\n" + describe_fading(gain);
}

int run_build(const BuildOptions& options) {
  if (!(options.tolerance > 0)) {
    throw InputError("--tolerance: expected a length above zero");
  }
  const model::Robot robot = model::load_robot(options.model);
  const recording::Recording path = recording::read_program_of(robot.elastic, options.path);
  const recording::Samples& q_cmd = recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6");
  std::vector<JointVector<double, 6>> points;
  for (Eigen::Index row = 0; row < q_cmd.rows(); ++row) {
    points.emplace_back(q_cmd.row(row).transpose());
  }
  std::vector<std::uint32_t> words;
  TableRequirements<double> wanted = requirements(options, path);
  control::GainLimit gain;
  if (!options.process.is_none) {
    gain = control::gain_limit_along(robot.elastic, path, options.process.process,
                                     options.process.loop);
    wanted.largest_gain = gain.safe;
  }
  try {
    words = build(robot.elastic, points, wanted);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", options.path, error.what()));
  }
  const std::string bytes(reinterpret_cast<const char*>(words.data()),
                          words.size() * sizeof(std::uint32_t));
  files::write_text(options.out, bytes + trailer_for(bytes, options.signing));
  Table table;
  Table::open(words.data(), 4 * words.size(), &table);
  if (options.json) {
    nlohmann::ordered_json json = summary(table);
    json["process"] = to_json(options.process);
    fmt::print("{}\n", json.dump(2));
  } else {
    const TableHeader& header = table.header();
    fmt::print(
        "{}: {} nodes, {} bytes\ncertified: no deflection or corrected position is off by more "
        "than "
        "{:.3g} µm and {:.3g} µrad\nfor any force up to {:.6g} N and moment up to {:.6g} N·m\n",
        options.out, header.node_count, header.size, 1e6 * header.position_error,
        1e6 * header.orientation_error, header.force_bound, header.moment_bound);
    fmt::print("{}\n", gain_text(gain, options.process));
  }
  return kDone;
}

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
    const auto error = table_error_at<double, 6>(robot.elastic, table, q, &cursor);
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

/// What can be said of the largest gain, which no table can prove alone: the process decides it.
struct GainCheck {
  bool checked = false;
  bool holds = true;
  std::string text;
};

GainCheck check_gain(const VerifyOptions& options, const model::Robot& robot, const Table& table) {
  const auto stated = static_cast<double>(table.header().largest_gain);
  const auto name_of = [](double value) {
    return value <= 0                           ? std::string("not analysed")
           : value <= control::GainLimit::kNone ? std::string("none is safe")
                                                : fmt::format("{:.4g}", value);
  };
  const std::string name = name_of(stated);
  GainCheck gain;
  if (options.path.empty()) {
    gain.text = fmt::format(
        "largest safe gain:                {}: NOT CHECKED, which takes --path\n", name);
    return gain;
  }
  const double found =
      options.process.is_none
          ? 0
          : control::gain_limit_along(robot.elastic,
                                      recording::read_program_of(robot.elastic, options.path),
                                      options.process.process, options.process.loop)
                .safe;
  gain.checked = true;
  gain.holds = std::abs(stated - found) <= 1e-6 * found;
  gain.text = fmt::format(
      "largest safe gain:                {}; found {}{}\n", name,
      found > 0 ? fmt::format("{:.4g} with {}", found, describe(options.process)) : "no process",
      gain.holds ? "" : ": NOT THE SAME");
  return gain;
}

int run_verify(const VerifyOptions& options) {
  const bool is_signed = !options.key.empty();
  const std::uint32_t version = is_signed ? signed_version(options.table, options.key) : 0;
  const model::Robot robot = model::load_robot(options.model);
  const TableFile file = read_unproven_table(options.table, robot);
  const Certificate certificate = derive_certificate(options.table, robot, file.table);
  const TableError<double> worst = largest_error(options, robot, file.table);
  const GainCheck gain = check_gain(options, robot, file.table);
  const TableHeader& header = file.table.header();
  const bool holds = certificate.holds && worst.position <= header.position_error &&
                     worst.orientation <= header.orientation_error;
  if (options.json) {
    nlohmann::ordered_json json = summary(file.table);
    if (is_signed) {
      json["signed_version"] = version;
    }
    json["samples"] = options.samples;
    json["largest_position_error"] = worst.position;
    json["largest_orientation_error"] = worst.orientation;
    json["derived_position_error"] = certificate.error.position;
    json["derived_orientation_error"] = certificate.error.orientation;
    json["gain_checked"] = gain.checked;
    json["holds"] = holds && gain.holds;
    fmt::print("{}\n", json.dump(2));
  } else {
    if (is_signed) {
      fmt::print("signed with this key, as version {}\n", version);
    }
    fmt::print(
        "largest error found at {} places: {:.4g} µm, {:.4g} µrad\n"
        "bound derived from its nodes:     {:.4g} µm, {:.4g} µrad\n"
        "{}"
        "certified bound:                  {:.4g} µm, {:.4g} µrad: {}\n",
        options.samples, 1e6 * worst.position, 1e6 * worst.orientation,
        1e6 * certificate.error.position, 1e6 * certificate.error.orientation, gain.text,
        1e6 * header.position_error, 1e6 * header.orientation_error,
        holds && gain.holds ? "holds" : "DOES NOT HOLD");
  }
  return holds && gain.holds ? kDone : kDoesNotHold;
}

/// Of the controller that the largest safe gain is for.
void add_loop(CLI::App* command, control::CorrectionLoop* loop) {
  command->add_option("--loop-period", loop->period, "s, of the controller")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--loop-filter-cutoff", loop->filter_cutoff,
                   "Hz, of the controller's filter on the wrench; 0: none")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--loop-delay", loop->delay,
                   "s, from the wrench to the robot standing corrected")
      ->check(CLI::NonNegativeNumber);
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
  auto verify = std::make_shared<VerifyOptions>();
  command->require_subcommand(0, 1);
  CLI::Option* model = command->add_option("--model", build->model, "robot.yaml");
  CLI::Option* path =
      command->add_option("--path", build->path, "recording with t, q_cmd and the wrench");
  CLI::Option* out = command->add_option("--out", build->out, "table to write");
  command->add_option("--tolerance", build->tolerance, "m, largest allowed error at the TCP");
  command->add_option("--orientation-tolerance", build->orientation_tolerance,
                      "rad; if not given, the number of --tolerance");
  command->add_option("--force", build->force,
                      "N, largest force to certify for; if not given, 1.1 times the path's");
  command->add_option("--moment", build->moment,
                      "N·m, largest moment to certify for; if not given, 1.1 times the path's");
  add_process(command, &build->process);
  add_loop(command, &build->process.loop);
  add_signing(command, &build->signing);
  command->add_flag("--json", build->json, "print the certificate as JSON");

  CLI::App* check = command->add_subcommand("verify",
                                            "Compare a table with the model: its header, the "
                                            "certificate derived again from its nodes, and\n"
                                            "the error at many places; with the path and the "
                                            "process also the largest gain. Exit code 1 if\n"
                                            "the certified bound or the gain does not hold, 2 if "
                                            "the file is damaged or belongs to another\n"
                                            "robot.");
  check->add_option("table", verify->table, "table to check")->required();
  check->add_option("--model", verify->model, "robot.yaml")->required();
  check->add_option("--key", verify->key, "the table must be signed with the key in this file");
  check->add_option("--path", verify->path,
                    "look along this program too, besides the chords between the table's nodes");
  add_process(check, &verify->process);
  add_loop(check, &verify->process.loop);
  check->add_option("--samples", verify->samples, "places to look at")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000000}));
  check->add_flag("--json", verify->json, "print the result as JSON");

  CLI::App* sign = add_table_sign(command, action);

  check->callback([=] { *action = [=] { return run_verify(*verify); }; });
  command->callback([=] {
    if (check->parsed() || sign->parsed()) {
      return;
    }
    for (const CLI::Option* option : {model, path, out}) {
      if (option->count() == 0) {
        throw CLI::RequiredError(option->get_name());
      }
    }
    *action = [=] { return run_build(*build); };
  });
}

}  // namespace flexcomp::cli
