#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/milling_options.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "recording/recording.hpp"
#include "study/path_wrench.hpp"

namespace flexcomp::cli {
namespace {

struct ForceOptions {
  MillingOptions milling;
  study::Spindle spindle;
  RobotChoice model;
  std::string path;
  std::string out;
  bool json = false;
};

/// The largest force (N) in a revolution.
double peak_force(const study::EndMilling& milling) {
  constexpr int kSteps = 3600;
  double peak = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * M_PI * i / kSteps;
    peak = std::max(peak, study::instantaneous_wrench(milling, angle).head<3>().norm());
  }
  return peak;
}

int run(const ForceOptions& options) {
  const study::EndMilling milling = milling_of(options.milling);
  if (options.path.empty() != options.out.empty() ||
      options.path.empty() != options.model.empty()) {
    throw InputError("--model, --path and --out go together");
  }
  if (!options.path.empty()) {
    study::Spindle spindle = options.spindle;
    spindle.is_mean = spindle.speed == 0;
    const model::Robot robot = load_robot(options.model);
    const RobotModel<double, 6> elastic = model::six_axis_model(robot);
    recording::Recording path = recording::read_recording_of(robot.elastic, options.path);
    recording::write_recording(
        options.out, study::with_milling_wrench(elastic, std::move(path), milling, spindle));
  }
  const Wrench<double> mean = study::mean_wrench(milling);
  const double peak = peak_force(milling);
  if (options.json) {
    const nlohmann::ordered_json json = {{"mean_force", {mean[0], mean[1], mean[2]}},
                                         {"mean_moment", {mean[3], mean[4], mean[5]}},
                                         {"peak_force", peak}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print(
        "on the tool, along the feed, across it (z × feed), up the spindle:\n"
        "mean force  {:.1f}, {:.1f}, {:.1f} N\n"
        "mean moment at the tip  {:.2f}, {:.2f}, {:.2f} N·m\n"
        "largest force  {:.1f} N\n",
        mean[0], mean[1], mean[2], mean[3], mean[4], mean[5], peak);
    if (!options.out.empty()) {
      fmt::print("{}: the path with its wrench\n", options.out);
    }
  }
  return kDone;
}

}  // namespace

void add_force(CLI::App* app, Action* action) {
  auto options = std::make_shared<ForceOptions>();
  CLI::App* command = app->add_subcommand(
      "force",
      "The force of milling with a cylindrical end mill, by the standard mechanistic model\n"
      "(Altintas, Manufacturing Automation, 2012): shear and edge coefficients of the material,\n"
      "chip thickness by feed and runout, the edge integrated along its helix.\n\n"
      "With --model, --path and --out a path (t, q_cmd) is given its wrench: the mean, or with\n"
      "--speed every tooth's pass.\n"
      "Example: flexcomp force --diameter 0.016 --teeth 4 --helix 0.52 --depth 0.003\n"
      "  --feed-per-tooth 8e-5 --shear 700e6,210e6,110e6 --edge 24e3,28e3,3e3");
  for (CLI::Option* option : add_milling(command, &options->milling)) {
    option->required();
  }
  add_robot(command, &options->model);
  command->add_option("--path", options->path, "recording with t and q_cmd");
  command->add_option("--out", options->out, "recording to write: the path with its wrench");
  command->add_option("--speed", options->spindle.speed, "of the spindle, rad/s");
  command->add_flag("--json", options->json, "one JSON object, N and N·m");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
