#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "planning/way.hpp"
#include "recording/plausible_angles.hpp"

namespace flexcomp::cli {
namespace {

struct ContourOptions {
  RobotChoice model;
  std::string path;
  std::string recording;
  bool json = false;
};

int run(const ContourOptions& options) {
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  const recording::Recording path = recording::read_recording_of(robot.elastic, options.path);
  const recording::Samples& q = recording::require(path, path.q_cmd, "q_cmd_1..q_cmd_6");
  if (q.rows() < 2) {
    throw InputError(fmt::format("{}: a path needs two rows or more", path.file));
  }
  const recording::Recording recording =
      recording::read_recording_of(robot.elastic, options.recording);
  const planning::ContourError error =
      planning::contour_error(planning::Way(planning::places_of(elastic, q)),
                              recording::require(recording, recording.position, "x,y,z"));
  if (options.json) {
    const nlohmann::ordered_json json = {
        {"largest", error.largest}, {"rms", error.mean_square}, {"row", error.row + 1}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("off the path's contour: {:.4f} mm at most ({}), {:.4f} mm root mean square\n",
               1e3 * error.largest, recording.place(static_cast<Eigen::Index>(error.row)),
               1e3 * error.mean_square);
  }
  return kDone;
}

}  // namespace

void add_contour(CLI::App* app, Action* action) {
  auto options = std::make_shared<ContourOptions>();
  CLI::App* command = app->add_subcommand(
      "contour",
      "How far positions (x,y,z) are from the contour of a path that they follow, whatever their\n"
      "times and number: the way of the stiff robot's TCP along q_cmd, straight between its rows.\n"
      "Example: flexcomp contour --model robot.yaml --path path.csv --recording recording.csv");
  add_robot(command, &options->model)->required();
  command->add_option("--path", options->path, "recording with q_cmd: what was wanted")->required();
  command->add_option("--recording", options->recording, "recording with x,y,z")->required();
  command->add_flag("--json", options->json, "one JSON object, m");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
