#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>

#include "build_info.hpp"
#include "check/model_checks.hpp"
#include "check/recording_checks.hpp"
#include "cli/command.hpp"
#include "cli/joint_names.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "cli/stage_line.hpp"
#include "diagnosis/diagnosis.hpp"
#include "diagnosis/output/json.hpp"
#include "diagnosis/output/report.hpp"
#include "diagnosis/output/sentences.hpp"
#include "diagnosis/search/tried_law.hpp"
#include "effects/law.hpp"
#include "effects/learned.hpp"
#include "effects/temperature.hpp"
#include "error.hpp"
#include "files/one_line.hpp"
#include "files/text_file.hpp"
#include "simulation/quasi_static.hpp"

namespace flexcomp::cli {
namespace {

/// Rows and scalars that are looked at in all; more tell little, and take time and memory.
constexpr Eigen::Index kMostRows = 8000;
constexpr Eigen::Index kMostSamples = 48000;  // of all components, six a row

struct DiagnoseOptions {
  RobotChoice model;
  std::vector<std::string> recordings;
  std::vector<std::string> holdouts;
  std::vector<std::string> laws;
  std::vector<std::string> without;
  std::string out;
  double false_discovery = 0.01;
  std::optional<double> law_seconds;
};

Eigen::Index components(const recording::Recording& recording) {
  return (recording.position ? 3 : 0) + (recording.tau ? 6 : 0) +
         (recording.q_link && recording.q_meas ? 6 : 0);
}

/// Recordings that are diagnosed together show the same things in the same way.
void refuse_unlike(const recording::Recording& first, const recording::Recording& other,
                   const simulation::Scene& first_scene, const simulation::Scene& other_scene) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}; diagnose them one by one", other.file, why));
  };
  if (first_scene.is_static != other_scene.is_static) {
    refuse(fmt::format("is {}, unlike {}",
                       other_scene.is_static ? "a load test (t = 0, 1, 2, …)" : "no load test",
                       first.file));
  }
  const std::pair<const char*, std::pair<bool, bool>> groups[] = {
      {"q_meas_1..n", {first.q_meas.has_value(), other.q_meas.has_value()}},
      {"q_link_1..n", {first.q_link.has_value(), other.q_link.has_value()}},
      {"tau_1..n", {first.tau.has_value(), other.tau.has_value()}},
      {"fx..mz", {first.wrench.has_value(), other.wrench.has_value()}},
      {"x,y,z", {first.position.has_value(), other.position.has_value()}},
      {"temp_c", {first.temperature.has_value(), other.temperature.has_value()}}};
  for (const auto& [columns, there] : groups) {
    if (there.first != there.second) {
      refuse(fmt::format("{} the columns {}, unlike {}", there.second ? "has" : "lacks", columns,
                         first.file));
    }
  }
}

std::vector<recording::Recording> read_recordings(const DiagnoseOptions& options, int joints) {
  std::vector<recording::Recording> recordings;
  for (const auto* files : {&options.recordings, &options.holdouts}) {
    for (const std::string& file : *files) {
      recordings.push_back(recording::read_recording(file, joints));
    }
  }
  return recordings;
}

/// Units, signs, axes and frames come before any physics: what is wrong there is said first.
check::Checks check_input(const model::Robot& robot,
                          const std::vector<recording::Recording>& recordings) {
  check::Checks checks = check::check_model(robot);
  for (const recording::Recording& each : recordings) {
    check::add(check::check_recording(&robot, each), &checks);
  }
  checks = check::worst_first(std::move(checks));
  for (const check::Check& each : checks) {
    if (each.severity != check::Severity::note) {
      fmt::print("{}\n", with_joint_names(check::sentence(each), robot));
    }
  }
  std::fflush(stdout);
  return checks;
}

/// Did the checks find nothing wrong with the recordings? Such a fault is to be mended: no law is
/// composed for millimetres in the place of metres. What is odd about a model may be meant so.
bool are_in_order(const check::Checks& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const check::Check& each) {
    return each.severity == check::Severity::note || each.about == "model";
  });
}

/// With angles in degrees the arm stands elsewhere in every row: nothing that follows would be
/// true.
void refuse_degrees(const check::Checks& checks) {
  for (const check::Check& each : checks) {
    if (each.severity == check::Severity::error && each.name == "units.angle") {
      throw InputError("no diagnosis of joint angles in degrees: mend that first (units.angle)");
    }
  }
}

/// The checks of units that found something, by name.
std::string wrong_units(const check::Checks& checks) {
  std::string names;
  for (const check::Check& each : checks) {
    if (each.name.rfind("units.", 0) == 0) {
      names += (names.empty() ? "" : ", ") + each.name;
    }
  }
  return names;
}

std::vector<simulation::Scene> scenes_of(const std::vector<recording::Recording>& recordings,
                                         std::vector<diagnosis::Quality>* qualities) {
  std::vector<simulation::Scene> scenes;
  for (const recording::Recording& each : recordings) {
    const Eigen::Index most =
        std::min(kMostRows, kMostSamples / std::max<Eigen::Index>(components(each), 1)) /
        static_cast<Eigen::Index>(recordings.size());
    qualities->push_back({each.file, {}});
    scenes.push_back(
        simulation::prepare(each, std::max<Eigen::Index>(most, 1), &qualities->back().preparation));
    refuse_unlike(recordings.front(), each, scenes.front(), scenes.back());
  }
  return scenes;
}

/// Returns the command that was given, for the page.
std::string command_line(const DiagnoseOptions& options) {
  std::string line = "flexcomp diagnose " + describe(options.model);
  for (const std::string& file : options.recordings) {
    line += " --recording " + file;
  }
  for (const std::string& file : options.holdouts) {
    line += " --holdout " + file;
  }
  for (const std::string& file : options.laws) {
    line += " --law " + file;
  }
  for (const std::string& effect : options.without) {
    line += " --without " + effect;
  }
  if (options.law_seconds) {
    line += fmt::format(" --law-seconds {:g}", *options.law_seconds);
  }
  return line +
         fmt::format(" --out {} --false-discovery {:g}", options.out, options.false_discovery);
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  char text[32] = "";
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local);
  return text;
}

/// Prints what a person reads first, on the terminal.
void summarize(const model::Robot& robot, const diagnosis::Observations& observations,
               const diagnosis::Diagnosis& result, const std::string& folder) {
  const auto say = [&](const std::string& sentence) {
    fmt::print("{}\n", with_joint_names(sentence, robot));
  };
  for (const diagnosis::ClockCheck& clock : result.clocks) {
    say(diagnosis::statement_of_clock(clock));
  }
  for (const diagnosis::Excitation& joint : result.excitation) {
    if (joint.tells_nothing()) {
      say(fmt::format("what can be told of joint {}: {}", joint.joint, diagnosis::verdict(joint)));
    }
  }
  fmt::print("{}{}\n", name_of(result.verdict), result.reason.empty() ? "" : ": " + result.reason);
  for (std::size_t i = 0; i < result.choice.findings.size(); ++i) {
    say(diagnosis::statement(observations, result, i));
  }
  for (const diagnosis::Event& event : result.events) {
    say(diagnosis::statement_of_event(observations, event));
  }
  const std::string left = diagnosis::statement_of_left(result);
  if (!left.empty()) {
    say(left);
  }
  for (const diagnosis::Trial& trial : result.trials) {
    say(diagnosis::statement_of_trial(observations, trial));
  }
  if (!result.retuned.chosen.empty()) {
    say(diagnosis::statement_of_retuned(observations, result));
  }
  const std::string band = diagnosis::statement_of_band(observations, result);
  if (!band.empty()) {
    say(band);
  }
  if (result.laws_stopped) {
    say(diagnosis::kLawsStopped);
  }
  if (!result.suggested_experiment.empty()) {
    say(result.suggested_experiment);
  }
  fmt::print("{}/report.html, diagnosis.json, updated_model.yaml\n", folder);
}

/// Leaves effects out of what is sought.
void leave_out(const std::vector<std::string>& effects,
               std::vector<diagnosis::Hypothesis>* hypotheses) {
  const auto& all = effects::catalogue();
  for (const std::string& effect : effects) {
    if (std::none_of(all.begin(), all.end(),
                     [&](const effects::Effect& each) { return each.name == effect; })) {
      throw InputError(
          fmt::format("--without: '{}' is no effect of the catalogue", files::one_line(effect)));
    }
    hypotheses->erase(
        std::remove_if(hypotheses->begin(), hypotheses->end(),
                       [&](const diagnosis::Hypothesis& each) { return each.effect() == effect; }),
        hypotheses->end());
  }
}

/// Thousands of simulations are made and dropped. Their memory stays with the process: to give it
/// back and take it again costs a tenth of the time.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kMost = 1 << 30;  // bytes
  mallopt(M_MMAP_THRESHOLD, kMost);
  mallopt(M_TRIM_THRESHOLD, kMost);
#endif
}

/// Diagnoses, and shows how far it is.
diagnosis::Diagnosis diagnosed(const std::vector<diagnosis::Hypothesis>& hypotheses,
                               diagnosis::Settings settings,
                               diagnosis::Observations* observations) {
  Progress simulating("simulating hypotheses", hypotheses.size());
  StageLine choosing;
  settings.simulating = [&](std::size_t done, std::size_t) { simulating.show(done); };
  settings.choosing = [&](const std::string& stage) { choosing.begin(stage); };
  return diagnosis::diagnose(observations, hypotheses, settings);
}

/// Where a unit is wrong, the springs seem so in what follows: the unit is the first suspect.
[[noreturn]] void refuse_rest(const simulation::NoRest& error, const check::Checks& checks) {
  const std::string units = wrong_units(checks);
  if (units.empty()) {
    throw error;
  }
  throw InputError(
      fmt::format("{}; mend the units first, as said above ({}): the springs may be as "
                  "they should",
                  error.what(), units));
}

/// The robot with what was found, and with the temperature that it was reckoned from, if any was.
model::Robot updated_robot(const model::Robot& robot, const model::Robot& known,
                           const std::vector<effects::Placed>& found) {
  model::Robot updated = effects::with_learned(robot, found);
  if (std::any_of(found.begin(), found.end(),
                  [](const effects::Placed& each) { return each.law->traits.needs_temperature; })) {
    updated.reference_temperature = known.reference_temperature;
  }
  return updated;
}

/// Diagnoses recordings that were checked, and writes what was found.
void diagnose(const DiagnoseOptions& options, diagnosis::Settings settings,
              const model::Robot& robot, std::vector<simulation::Scene> scenes,
              const diagnosis::Origin& origin) {
  const model::Robot known = effects::with_reference_temperature(robot, scenes);
  simulation::Machine machine = effects::machine_of(known, scenes);
  diagnosis::Observations observations(std::move(machine), std::move(scenes),
                                       options.holdouts.size());
  std::vector<diagnosis::Hypothesis> hypotheses = diagnosis::all_hypotheses(observations);
  leave_out(options.without, &hypotheses);
  for (const std::string& file : options.laws) {
    hypotheses.push_back(diagnosis::read_tried_law(file, observations));
  }
  if (!options.law_seconds && !are_in_order(origin.checks)) {
    settings.law_seconds = 0;
  }
  const diagnosis::Diagnosis result = diagnosed(hypotheses, settings, &observations);
  // All of it is made before any of it is written, and written whole or not at all.
  const std::string json = diagnosis::to_json(observations, result, origin.checks).dump(2) + "\n";
  const std::string html = diagnosis::to_html(observations, result, origin);
  const std::filesystem::path folder(options.out);
  const std::filesystem::path updated = folder / "updated_model.yaml";
  const std::string yaml = model::robot_text(
      updated, updated_robot(robot, known, result.updated().placed(observations)));
  output_folder(options.out);
  files::write_texts(
      {{folder / "diagnosis.json", json}, {folder / "report.html", html}, {updated, yaml}});
  summarize(robot, observations, result, options.out);
}

int run(const DiagnoseOptions& options) {
  keep_freed_memory();
  if (!(options.false_discovery > 0 && options.false_discovery < 1)) {
    throw InputError("--false-discovery: expected a number between 0 and 1");
  }
  diagnosis::Settings settings;
  settings.false_discovery = options.false_discovery;
  settings.law_seconds = options.law_seconds.value_or(settings.law_seconds);
  if (!(settings.law_seconds >= 0 && std::isfinite(settings.law_seconds))) {
    throw InputError("--law-seconds: expected a number of seconds, or 0");
  }
  const model::Robot robot = load_robot(options.model);
  const std::vector<recording::Recording> recordings = read_recordings(options, robot.joints());
  diagnosis::Origin origin;
  std::vector<simulation::Scene> scenes = scenes_of(recordings, &origin.qualities);
  origin.checks = check_input(robot, recordings);
  refuse_degrees(origin.checks);
  origin.command = command_line(options);
  origin.version = FLEXCOMP_BUILD_INFO;
  origin.date = today();
  try {
    diagnose(options, settings, robot, std::move(scenes), origin);
  } catch (const simulation::NoRest& error) {
    refuse_rest(error, origin.checks);
  }
  return kDone;
}

}  // namespace

void add_diagnose(CLI::App* app, Action* action) {
  auto options = std::make_shared<DiagnoseOptions>();
  CLI::App* command = app->add_subcommand(
      "diagnose",
      "Where recordings and the simulation differ, and which physics the model lacks. Writes\n"
      "diagnosis.json, report.html and updated_model.yaml to the folder --out.\n"
      "Example: flexcomp diagnose --model robot.yaml --recording a.csv --out diagnosis");
  add_robot(command, &options->model)->required();
  command->add_option("--recording", options->recordings, "recording; may be given again")
      ->required()
      ->take_all();
  command
      ->add_option("--holdout", options->holdouts,
                   "recording to check with; else part of each recording is set aside")
      ->take_all();
  command
      ->add_option(
          "--law", options->laws,
          "a law of your own to weigh beside all others: a file with its place, its formula "
          "and\nthe ranges of its parameters; may be given again")
      ->take_all();
  command->add_option(
      "--law-seconds", options->law_seconds,
      "processor time (s) for composing laws that nobody listed where there is a mismatch, beside "
      "what\nis found and in its place; 0 for none; unless given, 40 where the recordings are in "
      "order");
  command
      ->add_option("--without", options->without,
                   "effect that is not sought, to see which law is found instead; may be given "
                   "again")
      ->take_all();
  command->add_option("--out", options->out, "folder to write to")->required();
  command->add_option("--false-discovery", options->false_discovery,
                      "chance of naming an effect that is not there");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
