#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "study/placement.hpp"

namespace flexcomp::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PlaceOptions {
  RobotChoice model;
  std::string path;
  std::string out;
  std::array<double, 3> most_shift = {0.5, 0.5, 0.3};
  study::PlacementRequest request;
  bool json = false;
};

Json displacement(const study::PlacedJob& job) {
  return {{"largest", job.largest}, {"rms", job.mean_square}};
}

/// Would more room bring more?
bool is_on_bound(const study::Placement& place, const study::PlacementRequest& request) {
  constexpr double kClose = 1e-3;  // m
  return ((request.most_shift - place.shift.cwiseAbs()).array() < kClose &&
          request.most_shift.array() > kClose)
      .any();
}

int run(const PlaceOptions& options) {
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  const recording::Recording path = recording::read_recording_of(robot.elastic, options.path);
  study::PlacementRequest request = options.request;
  request.most_shift = {options.most_shift[0], options.most_shift[1], options.most_shift[2]};
  Progress progress("placing", static_cast<std::size_t>(request.evaluations));
  const study::PlacedJob before = study::as_placed(elastic, path);
  const study::PlacedJob after = study::best_placement(
      elastic, path, request, [&](int done) { progress.show(static_cast<std::size_t>(done)); });
  recording::write_recording(options.out, after.path);
  const study::Placement& place = after.placement;
  if (options.json) {
    const Json json = {{"shift", {place.shift[0], place.shift[1], place.shift[2]}},
                       {"turn", place.turn},
                       {"spin", place.spin},
                       {"on_bound", is_on_bound(place, request)},
                       {"before", displacement(before)},
                       {"after", displacement(after)}};
    fmt::print("{}\n", json.dump(2));
    return kDone;
  }
  fmt::print(
      "shift {:.3f}, {:.3f}, {:.3f} m; turn {:.3f} rad about the vertical; tool {:.3f} rad about "
      "its "
      "axis\n"
      "displacement of the uncorrected TCP under the wrench, mm\n"
      "  as it was  largest {:.4f}, root mean square {:.4f}\n"
      "  placed     largest {:.4f}, root mean square {:.4f}\n",
      place.shift[0], place.shift[1], place.shift[2], place.turn, place.spin, 1e3 * before.largest,
      1e3 * before.mean_square, 1e3 * after.largest, 1e3 * after.mean_square);
  if (is_on_bound(place, request)) {
    fmt::print("the shift is as large as --most-shift lets it be: more might bring more\n");
  }
  return kDone;
}

}  // namespace

void add_place(CLI::App* app, Action* action) {
  auto options = std::make_shared<PlaceOptions>();
  CLI::App* command = app->add_subcommand(
      "place",
      "Where a job is displaced least: the path with its wrench is moved as a whole, and the tool\n"
      "turned about its own axis, within the joint limits and away from singularities.\n\n"
      "The largest displacement of the TCP under the wrench, uncorrected, is made least, first "
      "over\n"
      "all bounds, then nearby (NLopt: DIRECT-L, Sbplx).\n"
      "Example: flexcomp place --model robot.yaml --path path.csv --out placed.csv");
  study::PlacementRequest& request = options->request;
  add_robot(command, &options->model)->required();
  command->add_option("--path", options->path, "recording with t, q_cmd and the wrench")
      ->required();
  command->add_option("--out", options->out, "recording to write: the job in its new place")
      ->required();
  add_vector(command, "--most-shift", &options->most_shift, "either way, m, base frame");
  command->add_option("--most-turn", request.most_turn,
                      "about the vertical through its middle, either way, rad");
  command->add_option("--most-spin", request.most_spin, "of the tool about its axis, rad");
  command->add_option("--joint-margin", request.joint_margin, "from the joint limits, rad");
  command->add_option("--least-singular-value", request.least_singular_value,
                      "of the Jacobian, metres and radians alike");
  command->add_option("--points", request.points, "of the path, looked at while searching");
  command->add_option("--evaluations", request.evaluations, "of places");
  command->add_flag("--json", options->json, "one JSON object, m and rad");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
