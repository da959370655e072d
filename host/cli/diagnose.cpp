#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <ostream>

#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "diagnosis/diagnosis.hpp"
#include "error.hpp"
#include "files/text_file.hpp"

namespace flexcomp::cli {
namespace {

/// Rows and scalars that are looked at in all; more tell little, and take time and memory.
constexpr Eigen::Index kMostRows = 8000;
constexpr Eigen::Index kMostSamples = 48000;

struct Options {
  std::string model;
  std::vector<std::string> recordings;
  std::vector<std::string> holdouts;
  std::string out;
  double false_discovery = 0.01;
};

Eigen::Index components(const recording::Recording& recording) {
  return (recording.position ? 3 : 0) + (recording.tau ? 6 : 0) +
         (recording.q_link && recording.q_meas ? 6 : 0);
}

std::vector<simulation::Scene> read_scenes(const Options& options) {
  std::vector<recording::Recording> recordings;
  for (const auto* files : {&options.recordings, &options.holdouts}) {
    for (const std::string& file : *files) {
      recordings.push_back(recording::read_recording(file));
    }
  }
  std::vector<simulation::Scene> scenes;
  for (const recording::Recording& each : recordings) {
    const Eigen::Index most =
        std::min(kMostRows, kMostSamples / std::max<Eigen::Index>(components(each), 1)) /
        static_cast<Eigen::Index>(recordings.size());
    simulation::Preparation preparation;
    scenes.push_back(simulation::prepare(each, most, &preparation));
  }
  return scenes;
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be made a folder: {}", folder, error.message()));
  }
}

int run(const Options& options) {
  if (!(options.false_discovery > 0 && options.false_discovery < 1)) {
    throw InputError("--false-discovery: expected a number between 0 and 1");
  }
  simulation::Machine machine;
  machine.robot = model::load_robot(options.model);
  diagnosis::Observations observations(machine, read_scenes(options), options.holdouts.size());
  const std::vector<diagnosis::Hypothesis> hypotheses = diagnosis::all_hypotheses(observations);
  Progress simulating("simulating hypotheses", hypotheses.size());
  Progress choosing("choosing", 6);
  diagnosis::Settings settings;
  settings.false_discovery = options.false_discovery;
  settings.simulating = [&](std::size_t done, std::size_t) { simulating.show(done); };
  settings.choosing = [&](std::size_t done, std::size_t) { choosing.show(done); };
  const diagnosis::Diagnosis result = diagnosis::diagnose(&observations, hypotheses, settings);
  make_folder(options.out);
  files::write_file(std::filesystem::path(options.out) / "diagnosis.json",
                    [&](std::ostream& stream) {
                      stream << diagnosis::to_json(observations, result).dump(2) << '\n';
                    });
  fmt::print("{}\n{}\n", result.verdict, diagnosis::headline(observations, result));
  return kDone;
}

}  // namespace

void add_diagnose(CLI::App* app, Action* action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app->add_subcommand(
      "diagnose",
      "Where recordings and the simulation differ, and which physics the model lacks. Writes\n"
      "diagnosis.json, report.html and updated_model.yaml to the folder --out.\n"
      "Example: flexcomp diagnose --model robot.yaml --recording a.csv --out diagnosis");
  command->add_option("--model", options->model, "robot.yaml")->required();
  command->add_option("--recording", options->recordings, "recording; may be given again")
      ->required()
      ->take_all();
  command
      ->add_option("--holdout", options->holdouts,
                   "recording to check with; else part of each recording is set aside")
      ->take_all();
  command->add_option("--out", options->out, "folder to write to")->required();
  command->add_option("--false-discovery", options->false_discovery,
                      "chance of naming an effect that is not there");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
