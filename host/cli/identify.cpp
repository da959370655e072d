#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/help.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "recording/plausible_angles.hpp"
#include "study/identification.hpp"
#include "study/load_test_plan.hpp"

namespace flexcomp::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kUnlikely = 0.01;

struct IdentifyOptions {
  RobotChoice model;
  std::string recording;
  std::string out;
  std::array<double, 3> deviations = {1, 1, 1};
  study::SoughtSprings sought;
  bool json = false;
};

struct LoadTestPlanOptions {
  RobotChoice model;
  std::string out;
  study::PlanRequest request;
  bool json = false;
};

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Puts a spring that is told into the model; of any other the model's own value stays.
void put(const study::IdentifiedSpring& spring, std::size_t index,
         const study::SoughtSprings& sought, model::Robot* robot) {
  if (!spring.is_told()) {
    return;
  }
  const double value = spring.value;
  if (index < 6) {
    robot->elastic.joints[index].compliance = value;
  } else if (index < 12 && sought.base) {
    robot->elastic.base_compliance[static_cast<Eigen::Index>(index) - 6] = value;
  } else {
    robot->elastic.tool_compliance[static_cast<Eigen::Index>(index) % 6] = value;
  }
}

bool is_any_told(const study::Identification& found) {
  return std::any_of(found.springs.begin(), found.springs.end(),
                     [](const study::IdentifiedSpring& spring) { return spring.is_told(); });
}

/// Why a spring is not told.
std::string reason(const study::IdentifiedSpring& spring) {
  return spring.told == study::Told::not_loaded ? "not_loaded" : "interval_holds_zero";
}

Json to_json(const study::Identification& found, const recording::Recording& recording) {
  Json springs = Json::object();
  Json not_told = Json::object();
  for (const study::IdentifiedSpring& spring : found.springs) {
    const Json interval = {spring.lower, spring.upper};
    if (spring.is_told()) {
      springs[spring.name] = {
          {"value", spring.value}, {"std", spring.deviation}, {"interval_95", interval}};
      continue;
    }
    springs[spring.name] = nullptr;
    const bool is_loaded = spring.told != study::Told::not_loaded;
    not_told[spring.name] = {{"because", reason(spring)},
                             {"interval_95", is_loaded ? interval : Json(nullptr)}};
  }
  Json sums = Json::array();
  for (const study::IdentifiedSum& sum : found.sums) {
    sums.push_back({{"first", found.springs[sum.first].name},
                    {"second", found.springs[sum.second].name},
                    {"factor", sum.factor},
                    {"value", sum.value},
                    {"interval_95", {sum.lower, sum.upper}}});
  }
  return {{"schema", "flexcomp/identification/1"},
          {"springs", springs},
          {"not_told", not_told},
          {"sums", sums},
          {"noise", found.noise},
          {"condition_number", found.condition_number},
          {"degrees_of_freedom", found.freedom},
          {"postures", found.postures},
          {"largest_residual",
           {{"place", recording.place(found.largest_row)},
            {"deviations", found.largest_residual},
            {"p_value", found.outlier_chance}}},
          {"nonlinearity_p_value", found.nonlinearity_chance}};
}

void print_springs(const study::Identification& found) {
  fmt::print("{:10} {:>13} {:>13}   95 % interval, 1e-6 rad/(N·m) (translations: 1e-6 m/N)\n",
             "spring", "compliance", "deviation");
  for (const study::IdentifiedSpring& spring : found.springs) {
    if (spring.is_told()) {
      fmt::print("{:10} {:13.5f} {:13.5f}   {:.5f} to {:.5f}\n", spring.name, 1e6 * spring.value,
                 1e6 * spring.deviation, 1e6 * spring.lower, 1e6 * spring.upper);
    } else if (spring.told == study::Told::not_loaded) {
      fmt::print("{:10} these tests do not tell it: the model's value stays\n", spring.name);
    } else {
      fmt::print(
          "{:10} these tests do not tell it: the model's value stays (zero lies within "
          "{:.4g} to {:.4g})\n",
          spring.name, 1e6 * spring.lower, 1e6 * spring.upper);
    }
  }
  for (const study::IdentifiedSum& sum : found.sums) {
    fmt::print("{} + {:.4g} × {} is told, no more: {:.5f}, {:.5f} to {:.5f}\n",
               found.springs[sum.first].name, sum.factor, found.springs[sum.second].name,
               1e6 * sum.value, 1e6 * sum.lower, 1e6 * sum.upper);
  }
}

void print(const study::Identification& found, const recording::Recording& recording) {
  print_springs(found);
  fmt::print(
      "noise of a coordinate {:.1f} µm, {} degrees of freedom, {} postures, condition number "
      "{:.1f}\n",
      1e6 * found.noise, found.freedom, found.postures, found.condition_number);
  if (found.outlier_chance < kUnlikely) {
    fmt::print(
        "{}: off by {:.1f} standard deviations: is it right, and the others of its posture?\n",
        recording.place(found.largest_row), found.largest_residual);
  }
  if (found.nonlinearity_chance < kUnlikely) {
    fmt::print("the springs are not linear (p = {:.1g}): try flexcomp diagnose\n",
               found.nonlinearity_chance);
  }
}

/// Springs that no robot has come of numbers that are not what they should be.
void refuse_impossible(const study::Identification& found) {
  for (const study::IdentifiedSpring& spring : found.springs) {
    if (spring.told == study::Told::against_load) {
      throw InputError(fmt::format(
          "{} would give against its load: the wrench must be that on the robot, at the TCP, in "
          "the base frame",
          spring.name));
    }
    if (spring.told == study::Told::not_plausible) {
      throw InputError(fmt::format(
          "{} would have a compliance of {:.3g}, as no robot has: forces must be in N, moments in "
          "N·m, lengths in m, angles in rad",
          spring.name, spring.value));
    }
  }
}

int run(const IdentifyOptions& options) {
  model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  const recording::Recording recording =
      recording::read_recording_of(robot.elastic, options.recording);
  const study::Identification found = study::identify_springs(
      elastic, recording, options.sought,
      {options.deviations[0], options.deviations[1], options.deviations[2]});
  refuse_impossible(found);
  const bool is_told = is_any_told(found);
  if (!options.out.empty() && is_told) {
    for (std::size_t i = 0; i < found.springs.size(); ++i) {
      put(found.springs[i], i, options.sought, &robot);
    }
    model::write_robot(options.out, robot);
  }
  if (options.json) {
    fmt::print("{}\n", to_json(found, recording).dump(2));
  } else {
    print(found, recording);
    if (!is_told) {
      fmt::print("no spring is told: nothing is written\n");
    }
  }
  return is_told ? kDone : kDoesNotHold;
}

int run_plan(const LoadTestPlanOptions& options) {
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  Progress progress("planning", 1000);
  const study::LoadTestPlan plan = study::plan_load_tests(
      elastic, options.request,
      [&](std::size_t done, std::size_t most) { progress.show(1000 * done / most); });
  const double gain = study::gain_over_random(elastic, plan, options.request);
  recording::write_recording(options.out, study::as_recording(plan));
  Json widths = Json::object();
  std::string text;
  for (std::size_t i = 0; i < plan.names.size(); ++i) {
    const double width = plan.half_width[static_cast<Eigen::Index>(i)];
    widths[plan.names[i]] = finite_or_null(width);
    text += std::isfinite(width) ? fmt::format("{:10} ± {:.1f} %\n", plan.names[i], 100 * width)
                                 : fmt::format("{:10} no such test tells it\n", plan.names[i]);
  }
  if (options.json) {
    const Json json = {{"tests", plan.tests.size()},
                       {"is_precise", plan.is_precise},
                       {"half_width_95", widths},
                       {"gain_over_random", gain}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{} load tests; what they tell (95 %):\n{}", plan.tests.size(), text);
    fmt::print("variance of as many tests at random: {:.1f} times as large (median)\n", gain);
    if (!plan.is_precise) {
      fmt::print("the precision is not reached: more force, less noise, or more than {} tests\n",
                 options.request.most);
    }
  }
  return plan.is_precise ? kDone : kDoesNotHold;
}

void add_sought(CLI::App* command, study::SoughtSprings* sought) {
  command->add_flag("--base", sought->base, "the base's springs too");
  command->add_flag("--tool", sought->tool, "the tool's springs too");
}

}  // namespace

void add_identify(CLI::App* app, Action* action) {
  auto options = std::make_shared<IdentifyOptions>();
  CLI::App* command = app->add_subcommand(
      "identify",
      "Compliances from static load tests: weighted least squares, 95 % intervals, what the tests\n"
      "cannot tell, readings that stand out, springs that are not linear.\n\n"
      "A load test is a recording with t = 0, 1, 2, …, q_meas or q_cmd, the wrench and x, y, z; "
      "each\n"
      "posture needs two loads or more (none is a load too). Errors of the geometry do not "
      "matter.\n"
      "A spring whose 95 % interval holds zero is not told: the model's value stays. Exit code 1 "
      "if\n"
      "none is told.\n"
      "Example: flexcomp identify --model robot.yaml --recording load.csv --out identified.yaml\n"
      "         flexcomp identify plan --model robot.yaml --force 2000 --out plan.csv");
  CLI::Option* model = add_model(command, &options->model);
  CLI::Option* recording = command->add_option("--recording", options->recording, "load tests");
  command->add_option("--out", options->out, "robot.yaml to write, with the springs that are told");
  add_vector(command, "--deviations", &options->deviations,
             "of measured x, y and z; their proportions count");
  add_sought(command, &options->sought);
  command->add_flag("--json", options->json, "one JSON object, SI units");

  auto planned = std::make_shared<LoadTestPlanOptions>();
  CLI::App* plan = command->add_subcommand(
      "plan",
      "Postures and loads that tell the springs to a stated precision with few tests (D-optimal),\n"
      "and how much better they are than as many at random. Exit code 1 if the precision is not\n"
      "reached.\n"
      "Example: flexcomp identify plan --model robot.yaml --force 2000 --noise 50e-6 --out "
      "plan.csv");
  study::PlanRequest& request = planned->request;
  add_model(plan, &planned->model, "robot.yaml; the tool's tip is where the load acts")->required();
  plan->add_option("--out", planned->out, "recording to write: t, q_cmd, wrench")->required();
  plan->add_option("--force", request.force, "of each load, N");
  plan->add_option("--noise", request.noise, "of a measured coordinate, m");
  plan->add_option("--precision", request.precision,
                   "half a 95 % interval over the compliance, for every spring in the model");
  plan->add_option("--least-height", request.least_height, "of the TCP, m");
  plan->add_option("--most", request.most, "tests");
  plan->add_option("--seed", request.seed, "of the postures to choose from");
  add_sought(plan, &request.sought);
  plan->add_flag("--json", planned->json, "one JSON object");
  require_without_subcommand(command, {model, recording});
  plan->callback([=] { *action = [=] { return run_plan(*planned); }; });
  command->callback([=] {
    if (!command->got_subcommand(plan)) {
      *action = [=] { return run(*options); };
    }
  });
}

}  // namespace flexcomp::cli
