#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "check/config_checks.hpp"
#include "check/json.hpp"
#include "check/model_checks.hpp"
#include "check/path_checks.hpp"
#include "check/recording_checks.hpp"
#include "check/times.hpp"
#include "cli/command.hpp"
#include "cli/joint_names.hpp"
#include "cli/process_options.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "error.hpp"

namespace flexcomp::cli {
namespace {

struct CheckOptions {
  RobotChoice model;
  std::vector<std::string> recordings;
  std::string path;
  std::string table;
  std::string config;
  ProcessOptions process;
  bool json = false;
};

/// A recording whose times need not increase: what does not is told, and left out.
recording::Recording read_with_times(const std::string& file, const char* about,
                                     const model::Robot* robot, check::Checks* checks) {
  recording::NumberTable table = recording::read_csv(file);
  check::Checks order = check::check_order_of_times(&table);
  for (check::Check& each : order) {
    each.about = about;
  }
  check::add(std::move(order), checks);
  return robot == nullptr ? recording::recording_of(table)
                          : recording::recording_of(table, robot->joints());
}

bool holds(const check::Checks& checks) {
  return std::none_of(checks.begin(), checks.end(), [](const check::Check& each) {
    return each.severity == check::Severity::error;
  });
}

/// The table that a configuration names. What is wrong with it is told of the configuration.
std::optional<TableFile> read_table_of(const std::string& config, const Options& options,
                                       check::Checks* checks) {
  try {
    return read_any_table(options.table);
  } catch (const InputError& error) {
    checks->push_back({check::Severity::error, "config", "config.table",
                       fmt::format("{}: table: {}", config, error.what()),
                       "make it with flexcomp table, and name it in the configuration"});
    return std::nullopt;
  }
}

/// flexcompd's own reading of its configuration, which makes its own complaints.
Options read_config(const std::string& file) {
  const char* const words[] = {"flexcompd", "--config", file.c_str(), "--can", "none"};
  int exit_code = 0;
  const std::optional<Options> options = read_options(5, words, &exit_code);
  if (!options) {
    throw InputError(file + ": no configuration of flexcompd, as said above");
  }
  return *options;
}

check::Checks check_all(const CheckOptions& options, const std::optional<model::Robot>& robot) {
  check::Checks checks;
  if (robot) {
    check::add(check::check_model(*robot), &checks);
  }
  const model::Robot* known = robot ? &*robot : nullptr;
  for (const std::string& file : options.recordings) {
    check::add(check::check_recording(known, read_with_times(file, "recording", known, &checks)),
               &checks);
  }
  std::optional<Options> config;
  if (!options.config.empty()) {
    config = read_config(options.config);
  }
  std::optional<TableFile> table;
  bool is_of_robot = false;
  if (!options.table.empty()) {
    table = read_any_table(options.table);
  } else if (config && !config->table.empty()) {
    table = read_table_of(options.config, *config, &checks);
  }
  if (table) {
    const std::string file = options.table.empty() ? config->table : options.table;
    const check::Checks found =
        robot ? check::check_table(*robot, file, table->table) : check::Checks{};
    is_of_robot = robot.has_value() && holds(found);
    check::add(found, &checks);
  }
  if (!options.path.empty()) {
    const recording::Recording path = read_with_times(options.path, "path", known, &checks);
    const check::Checks found = robot ? check::check_path(*robot, path) : check::Checks{};
    const bool is_usable = robot.has_value() && holds(found);
    check::add(found, &checks);
    if (is_usable && !options.process.is_none) {
      check::add(check::check_process(*robot, path, options.process.process, options.process.loop),
                 &checks);
    }
    if (is_usable && config) {
      check::add(check::check_deflection(options.config, *config, *robot, path), &checks);
    }
    if (is_usable && is_of_robot) {
      check::add(check::check_coverage(*robot, table->table, path), &checks);
    }
  }
  if (config) {
    check::add(check::check_config(options.config, *config, known, table ? &table->table : nullptr),
               &checks);
  }
  return check::worst_first(std::move(checks));
}

void print_for_a_person(const check::Checks& checks, const std::optional<model::Robot>& robot) {
  for (const check::Check& each : checks) {
    const std::string sentence = check::sentence(each);
    fmt::print("{}\n", robot ? with_joint_names(sentence, *robot) : sentence);
  }
  if (!check::is_something_wrong(checks)) {
    fmt::print("nothing is wrong\n");
  }
}

int run(const CheckOptions& options) {
  if (options.model.empty() && options.recordings.empty() && options.path.empty() &&
      options.table.empty() && options.config.empty()) {
    throw InputError(
        "nothing to check: expected --model, --recording, --path, --table or --config");
  }
  std::optional<model::Robot> robot;
  if (!options.model.empty()) {
    robot = load_robot(options.model);
  }
  const check::Checks checks = check_all(options, robot);
  if (options.json) {
    fmt::print("{}\n", nlohmann::ordered_json{{"checks", check::as_json(checks)}}.dump(2));
  } else {
    print_for_a_person(checks, robot);
  }
  return check::is_something_wrong(checks) ? kDoesNotHold : kDone;
}

}  // namespace

void add_check(CLI::App* app, Action* action) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app->add_subcommand(
      "check",
      "What is wrong or suspicious in a model, recordings, a path, a table, a configuration of\n"
      "flexcompd, in any combination: units, signs, axes, frames, limits, springs, stability, "
      "coverage.\n"
      "Most needs the model beside it. Exit code 0: nothing is wrong; 1: something is (an error or "
      "a\n"
      "warning; notes do not count); 2: a file cannot be read.\n"
      "Example: flexcomp check --model robot.yaml --recording a.csv");
  add_robot(command, &options->model);
  command->add_option("--recording", options->recordings, "recording; may be given again")
      ->take_all();
  command->add_option("--path", options->path, "recording with t, q_cmd and the wrench, to be run");
  command->add_option("--table", options->table, "made by flexcomp table");
  command->add_option("--config", options->config, "configuration of flexcompd");
  add_process(command, &options->process);
  command->add_flag("--json", options->json, "print the checks as JSON");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
