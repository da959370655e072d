#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/output_folder.hpp"
#include "cli/robot_choice.hpp"
#include "control/arc_circle.hpp"
#include "control/arc_request.hpp"
#include "control/arc_trials.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "report/gnuplot.hpp"

namespace flexcomp::cli {
namespace {

struct ArcDemoOptions {
  RobotChoice model;
  std::string uncertainty;
  std::string out;
  bool json = false;
};

template <typename Derived>
nlohmann::ordered_json list(const Eigen::MatrixBase<Derived>& values) {
  return std::vector<double>(values.derived().data(), values.derived().data() + values.size());
}

template <int Joints>
nlohmann::ordered_json figures_json(const control::TrackingFigures<Joints>& figures) {
  return {{"largest_error", list(figures.largest_error)},
          {"rms_error", list(figures.error)},
          {"rms_torque", list(figures.torque)},
          {"rms_torque_change", list(figures.torque_change)}};
}

template <int Joints>
nlohmann::ordered_json trial_json(const std::vector<control::TrialRun<Joints>>& runs) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const control::TrialRun<Joints>& run : runs) {
    all.push_back({{"controller", run.controller},
                   {"before_load", figures_json(run.before)},
                   {"after_load", figures_json(run.after)}});
    if (!run.bound.empty()) {
      all.back()["adapted_bound"] = list(run.bound.back());
    }
  }
  return all;
}

template <int Joints>
std::string trial_table(const std::vector<control::TrialRun<Joints>>& runs,
                        const std::string& title) {
  std::string text = fmt::format(
      "{}: largest error of the links in the settled part (norm over joints), before and after\n"
      "the load changes; torque and its change from tick to tick (rms)\n"
      "{:<26}{:>12}{:>12}{:>12}{:>16}\n",
      title, "", "before mrad", "after mrad", "torque N·m", "change N·m/tick");
  for (const control::TrialRun<Joints>& run : runs) {
    text += fmt::format("{:<26}{:>12.3f}{:>12.3f}{:>12.1f}{:>14.2f}\n", run.controller,
                        1e3 * run.before.largest_error.norm(), 1e3 * run.after.largest_error.norm(),
                        run.after.torque.norm(), run.after.torque_change.norm());
  }
  return text + "\n";
}

/// A file's content, by the file's name.
using Pictures = std::vector<std::pair<std::string, std::string>>;

void draw(const std::string& name, const std::string& script, Pictures* pictures) {
  pictures->emplace_back(name + ".svg", report::plot_svg(script, 1000, 600));
  pictures->emplace_back(name + ".png", report::plot_png(script, 1000, 600));
}

template <int Joints>
nlohmann::ordered_json try_arm(const control::Trial<Joints>& trial, const std::string& name,
                               const std::string& title, std::string* table, Pictures* pictures) {
  const std::vector<control::TrialRun<Joints>> runs = control::run_trial(trial);
  *table += trial_table(runs, title);
  draw(name + "_error", control::error_script(runs, title + ": tracking error"), pictures);
  draw(name + "_adaptation",
       control::bound_script(runs.back(), title + ": adaptation of the robust controller"),
       pictures);
  return trial_json(runs);
}

/// The request's robot with a tool that gives, all of it off by what is uncertain.
control::CircleTrial circle_trial(const control::ArcRequest& request,
                                  const ArcGains<double, 6>& gains) {
  control::CircleTrial trial;
  trial.nominal = request.arm;
  trial.nominal.model.tool_compliance << 1e-7, 1e-7, 3e-8, 0, 0, 0;  // m/N: spindle and holder
  std::mt19937_64 random(2);
  trial.arm = control::draw_arm(trial.nominal, request.uncertainty, &random).arm;
  trial.gains = gains;
  trial.plan.center = {2.0, 0, 1.2};
  trial.plan.first_axis = Vector3<double>::UnitX();
  trial.plan.second_axis = Vector3<double>::UnitZ();
  trial.plan.tool_axis = Vector3<double>::UnitY();
  trial.plan.feed = 0.05;
  trial.plan.force = {440, 1370, 635};
  trial.plan.moment = {0, 3, 10.5};
  return trial;
}

nlohmann::ordered_json try_circle(const control::CircleTrial& trial, const std::string& title,
                                  std::string* table, Pictures* pictures) {
  const std::vector<control::CircleRun> runs = control::mill_circle(trial);
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  *table += fmt::format("{}\n{:<32}{:>16}{:>22}{:>18}\n", title, "", "circularity mm",
                        "largest deviation mm", "correction mrad");
  for (const control::CircleRun& run : runs) {
    *table += fmt::format("{:<32}{:>16.3f}{:>22.3f}{:>18.3f}\n", run.control, 1e3 * run.circularity,
                          1e3 * run.deviation, 1e3 * run.correction);
    all.push_back({{"control", run.control},
                   {"circularity", run.circularity},
                   {"largest_deviation", run.deviation},
                   {"largest_correction", run.correction}});
  }
  draw("circle", control::circle_script(runs, trial.plan.radius, title + ", circularity"),
       pictures);
  return all;
}

int run(const ArcDemoOptions& options) {
  const model::Robot robot = load_robot(options.model);
  const control::ArcRequest request = control::read_arc_request(options.uncertainty, robot);
  const control::ArcDesign<6> design =
      control::design_arc<6>(request.arm, request.uncertainty, request.motion, request.bandwidth);
  std::string table;
  Pictures pictures;
  nlohmann::ordered_json summary = {{"schema", "flexcomp/arc-demo/1"}, {"robot", robot.name}};
  summary["two_link_arm"] =
      try_arm<2>(control::two_link_trial(), "two_link", "two-link arm", &table, &pictures);
  summary["six_axes"] =
      try_arm<6>(control::six_axis_trial(request.arm, request.uncertainty, request.motion, design),
                 "six_axes", robot.name, &table, &pictures);
  summary["circle"] = try_circle(circle_trial(request, design.gains),
                                 robot.name + ": milled circle", &table, &pictures);
  const std::filesystem::path folder = output_folder(options.out);
  for (const auto& [name, content] : pictures) {
    files::write_text(folder / name, content);
  }
  files::write_text(folder / "summary.json", summary.dump(2) + "\n");
  fmt::print("{}", options.json ? summary.dump(2) + "\n" : table);
  return kDone;
}

}  // namespace

void add_arc_demo(CLI::App* app, Action* action) {
  auto options = std::make_shared<ArcDemoOptions>();
  CLI::App* command = app->add_subcommand(
      "arc-demo",
      "Adaptive robust control in simulation: a two-link arm and the robot, off their models and\n"
      "picking up a load, under the motors' servo, robust and adaptive robust control; and a\n"
      "milled circle with and without the deflection compensator.\n\n"
      "Writes summary.json and pictures (.svg, .png) of errors, adaptation and the circle.\n"
      "Example: flexcomp arc-demo --model host/robots/kr360/robot.yaml \\\n"
      "           --uncertainty host/robots/kr360/arc.yaml --out arc-demo");
  add_robot(command, &options->model)->required();
  command->add_option("--uncertainty", options->uncertainty, "design file, as for design-arc")
      ->required();
  command->add_option("--out", options->out, "folder to write to")->required();
  command->add_flag("--json", options->json, "print summary.json");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
