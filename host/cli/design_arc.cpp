#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/output_folder.hpp"
#include "cli/robot_choice.hpp"
#include "control/arc_parameters.hpp"
#include "control/arc_picture.hpp"
#include "control/arc_request.hpp"
#include "control/quartic.hpp"
#include "error.hpp"
#include "files/text_file.hpp"
#include "report/gnuplot.hpp"

namespace flexcomp::cli {
namespace {

struct DesignArcOptions {
  RobotChoice model;
  std::string uncertainty;
  std::string out;
  int picture_joint = 2;
  bool json = false;
};

template <int Count>
nlohmann::ordered_json part_json(const control::ArcPart<Count>& part) {
  nlohmann::ordered_json bounds = nlohmann::ordered_json::array();
  for (const control::FuzzyNumber& parameter : part.parameters) {
    const control::Interval support = parameter.support();
    bounds.push_back({{"support", {support.lower, support.upper}}, {"mean", parameter.mean()}});
  }
  return {{"bound_parameters", bounds},
          {"bound_limit", part.bound_limit},
          {"gain_limit", part.gain_limit},
          {"cost",
           {{"kappa", {part.cost.constant, part.cost.linear, part.cost.square}},
            {"effort", part.cost.effort},
            {"least", part.cost(part.root)},
            {"at_gain", part.cost(part.gain)}}},
          {"quartic",
           {{"p", part.cost.p()},
            {"r", part.cost.r()},
            {"root", part.root},
            {"roots_by_companion",
             control::positive_roots_by_companion(part.cost.p(), part.cost.r())}}},
          {"gain", part.gain}};
}

nlohmann::ordered_json guarantee_json(const control::ArcGuarantee& promise) {
  const double level = 1.05 * promise.bound.residual();
  return {{"decay", promise.bound.decay},
          {"drift", promise.bound.drift},
          {"drift_of_filter", promise.filter_drift},
          {"residual", promise.bound.residual()},
          {"start", promise.start},
          {"uniform_bound",
           {{"level", promise.bound.most(promise.start)},
            {"tracking_error", promise.tracking_error(promise.bound.most(promise.start))}}},
          {"ultimate_bound",
           {{"level", level},
            {"time", promise.bound.time_to(level, promise.start)},
            {"tracking_error", promise.tracking_error(level)},
            {"link_surface", promise.link_surface(level)},
            {"motor_error", promise.motor_error(level)},
            {"link_parameters", promise.link_parameters(level)},
            {"motor_parameters", promise.motor_parameters(level)}}}};
}

nlohmann::ordered_json arc_summary(const model::Robot& robot, const control::ArcDesign<6>& design) {
  nlohmann::ordered_json joints = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < 6; ++i) {
    joints.push_back({{"joint", i + 1},
                      {"link", part_json(design.link[i])},
                      {"motor", part_json(design.motor[i])}});
  }
  return {{"schema", "flexcomp/arc-summary/1"},
          {"robot", robot.name},
          {"joints", joints},
          {"guarantee", guarantee_json(design.guarantee)}};
}

void print_design(const model::Robot& robot, const control::ArcDesign<6>& design) {
  fmt::print(
      "{}: gains of least fuzzy cost, each the one positive root of its quartic\n"
      "or, if less (*), the largest gain whose slope keeps within its limit\n"
      "joint   link: bound, N·m   gain, 1/W   motor: bound, N·m   gain, 1/W\n",
      robot.name);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto mark = [](const auto& part) { return part.gain < part.root ? '*' : ' '; };
    fmt::print("  {}   {:>17.4g} {:>11.4g}{} {:>18.4g} {:>11.4g}{}\n", i + 1,
               design.link[i].bound_limit, design.link[i].gain, mark(design.link[i]),
               design.motor[i].bound_limit, design.motor[i].gain, mark(design.motor[i]));
  }
  const control::ArcGuarantee& promise = design.guarantee;
  const double level = 1.05 * promise.bound.residual();
  fmt::print(
      "for every arm within the sets: V' <= -{:.3g} V + {:.4g} W; tracking error within "
      "{:.3g} rad after {:.2g} s\n"
      "(a certificate, in continuous time and without delay of sensors or motors; some tens to "
      "thousands\nof times what simulations show; see flexcomp arc-demo)\n",
      promise.bound.decay, promise.bound.drift, promise.tracking_error(level),
      promise.bound.time_to(level, promise.start));
}

int run(const DesignArcOptions& options) {
  const model::Robot robot = load_robot(options.model);
  const control::ArcRequest request = control::read_arc_request(options.uncertainty, robot);
  const control::ArcDesign<6> design =
      control::design_arc<6>(request.arm, request.uncertainty, request.motion, request.bandwidth);
  const control::ArcParameters parameters = control::arc_parameters(request.arm, design.gains);
  control::make_controller(parameters, request.arm);  // refuses what the core would refuse
  const auto joint = static_cast<std::size_t>(options.picture_joint - 1);
  const std::string script = control::cost_script(
      design.link[joint], design.motor[joint],
      fmt::format("{}: fuzzy cost of the gains of joint {}", robot.name, options.picture_joint));
  const nlohmann::ordered_json summary = arc_summary(robot, design);
  const std::string svg = report::plot_svg(script, 900, 800);
  const std::string png = report::plot_png(script, 900, 800);
  const std::filesystem::path folder = output_folder(options.out);
  control::write_arc_parameters(folder / "arc_gains.yaml", parameters);
  // The file holds what was designed, to the last bit.
  control::make_controller(control::read_arc_parameters(folder / "arc_gains.yaml"), request.arm);
  files::write_text(folder / "arc_gains.h", control::c_header(parameters, robot.name));
  files::write_text(folder / "cost.svg", svg);
  files::write_text(folder / "cost.png", png);
  files::write_text(folder / "summary.json", summary.dump(2) + "\n");
  if (options.json) {
    fmt::print("{}\n", summary.dump(2));
  } else {
    print_design(robot, design);
  }
  return kDone;
}

}  // namespace

void add_design_arc(CLI::App* app, Action* action) {
  auto options = std::make_shared<DesignArcOptions>();
  CLI::App* command = app->add_subcommand(
      "design-arc",
      "Adaptive robust control of the joints, springs included: from what is uncertain of a "
      "robot,\n"
      "as fuzzy sets, to bounds, gains of least cost and what they guarantee.\n\n"
      "Writes arc_gains.yaml (gains, for programs), arc_gains.h (the same for a controller in C),\n"
      "summary.json, and the cost over both gains of a joint as cost.svg and cost.png.\n"
      "Example: flexcomp design-arc --model robot.yaml --uncertainty arc.yaml --out arc");
  add_robot(command, &options->model)->required();
  command
      ->add_option("--uncertainty", options->uncertainty, "design file, see host/control/README.md")
      ->required();
  command->add_option("--out", options->out, "folder to write to")->required();
  command->add_option("--picture-joint", options->picture_joint, "whose cost is drawn")
      ->check(CLI::Range(1, 6));
  command->add_flag("--json", options->json, "print summary.json");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
