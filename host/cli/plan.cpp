#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "cli/command.hpp"
#include "cli/plan_program.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "planning/circle.hpp"

namespace flexcomp::cli {
namespace {

struct PlanOptions {
  RobotChoice model;
  std::string out;
  std::array<double, 3> center{};
  std::string plane = "xz";
  std::array<double, 3> tool_axis{};
  std::array<double, 3> force = kStudyForce;
  std::array<double, 3> moment = kStudyMoment;
  planning::CirclePlan plan{};
};

Vector3<double> unit_axis(char name) { return Vector3<double>::Unit(name - 'x'); }

int run(const PlanOptions& options, bool has_tool_axis) {
  planning::CirclePlan plan = options.plan;
  plan.center = Vector3<double>(options.center.data());
  plan.first_axis = unit_axis(options.plane[0]);
  plan.second_axis = unit_axis(options.plane[1]);
  plan.force = Vector3<double>(options.force.data());
  plan.moment = Vector3<double>(options.moment.data());
  plan.tool_axis = has_tool_axis ? Vector3<double>(options.tool_axis.data())
                                 : Vector3<double>(-plan.first_axis.cross(plan.second_axis));
  if (!(plan.tool_axis.norm() > 0) || !plan.tool_axis.allFinite()) {
    throw InputError("--tool-axis: expected a direction, not zero");
  }
  plan.tool_axis.normalize();
  if (!(plan.radius > 0) || !(plan.feed > 0) || plan.points < 8 || plan.points > 1000000) {
    throw InputError("--radius and --feed must be above zero, --points from 8 to 1000000");
  }
  const model::Robot robot = load_robot(options.model);
  Progress progress("planning", static_cast<std::size_t>(plan.points));
  const recording::Recording recording =
      planning::plan_circle(model::six_axis_model(robot), plan,
                            [&](int done) { progress.show(static_cast<std::size_t>(done)); });
  recording::write_recording(options.out, recording);
  fmt::print("{}: {} rows\n", options.out, recording.size());
  return kDone;
}

}  // namespace

void add_plan(CLI::App* app, Action* action) {
  CLI::App* plan = app->add_subcommand("plan", "Make a path with its cutting force.");
  plan->require_subcommand(1);
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = plan->add_subcommand(
      "circle",
      "A milled circle: joint angles by inverse kinematics, tool orientation constant, and a "
      "wrench\n"
      "that turns with the path. Force and moment are given as {out of the circle, along the "
      "feed,\n"
      "along the plane's normal}; the defaults are those of the study by Klimchik et al. (2017).\n"
      "Example: flexcomp plan circle --model robot.yaml --center 1.6,0,1.2 --plane xz --out "
      "path.csv");
  add_robot(command, &options->model)->required();
  command->add_option("--out", options->out, "recording to write: t, q_cmd, wrench")->required();
  add_vector(command, "--center", &options->center, "centre, m, base frame")->required();
  command->add_option("--plane", options->plane, "plane of the circle: first and second axis")
      ->check(CLI::IsMember({"xy", "yx", "xz", "zx", "yz", "zy"}));
  command->add_option("--radius", options->plan.radius, "m");
  command->add_option("--points", options->plan.points, "steps of the circle");
  command->add_option("--feed", options->plan.feed, "m/s");
  command->add_flag("--clockwise", options->plan.clockwise,
                    "from the second axis to the first instead of from the first to the second");
  CLI::Option* tool_axis = add_vector(
      command, "--tool-axis", &options->tool_axis,
      "where the tool points (its z axis), base frame; otherwise against first × second axis");
  tool_axis->default_str("");
  add_vector(command, "--force", &options->force, "N, on the tool");
  add_vector(command, "--moment", &options->moment, "N·m, on the tool");
  command->callback([=] {
    const bool has_tool_axis = tool_axis->count() > 0;
    *action = [=] { return run(*options, has_tool_axis); };
  });
  add_plan_program(plan, action);
}

CLI::Option* add_vector(CLI::App* command, const std::string& name, std::array<double, 3>* value,
                        const std::string& help) {
  return command->add_option(name, *value, help)->delimiter(',')->type_name("X,Y,Z");
}

}  // namespace flexcomp::cli
