#include "simulation/plant.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/process_options.hpp"
#include "cli/progress.hpp"
#include "cli/robot_choice.hpp"
#include "cli/table_file.hpp"
#include "control/arc_parameters.hpp"
#include "control/arc_request.hpp"
#include "control/dynamic_milling.hpp"
#include "control/path_gain.hpp"
#include "effects/running_laws.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "node/default_config.hpp"
#include "node/node_status.hpp"
#include "node/reply.hpp"
#include "recording/plausible_angles.hpp"
#include "simulation/displaced_robot.hpp"
#include "simulation/rsi_controller.hpp"

namespace flexcomp::cli {
namespace {

struct PlantOptions {
  RobotChoice model;
  std::string path;
  std::string bus;
  std::string rsi;
  std::string rsi_type = "ImFree";
  bool rsi_relative = false;
  std::string key;
  std::string table;
  std::string out;
  std::string dynamic;
  bool arc = false;
  double compliance_scale = 1;
  double gain = 1;
  double filter_cutoff = 20;
  ProcessOptions process;
  simulation::PlantOptions plant;
  bool allow_unstable = false;
  bool without_compensation = false;
  bool json = false;
};

NodeConfig node_config(const PlantOptions& options, const model::Robot& robot) {
  NodeConfig config = default_node_config();
  config.compensator.period = static_cast<float>(options.plant.period);
  config.compensator.gain = static_cast<float>(options.gain);
  config.compensator.filter_cutoff = static_cast<float>(options.filter_cutoff);
  config.compensator.model_hash = model_hash(model::six_axis_model(robot));
  return config;
}

/// Limit of the loop through the process that the plant cuts with, for the robot as it is.
GainLimit gain_limit_of(const PlantOptions& options, const model::Robot& known,
                        const recording::Recording& path) {
  CorrectionLoop loop = options.process.loop;
  loop.period = loop.delay = options.plant.period;
  loop.filter_cutoff = options.filter_cutoff;
  const FeedbackRange feedback = control::feedback_along(
      simulation::with_scaled_compliance(model::six_axis_model(known), options.compliance_scale),
      path, options.process.process);
  return gain_limit(feedback, loop, options.compliance_scale);
}

/// One line that says what would be stable, and how to have it.
std::string unstable_text(const GainLimit& limit) {
  return limit.digs_in()
             ? fmt::format("no stable gain is safe: {}; --allow-unstable mills all the same",
                           describe_digging_in(limit))
             : fmt::format(
                   "unstable: with this process the largest stable gain is {:.4g}, the largest "
                   "safe one {:.4g}: make the table for it (flexcomp table --depth-of-cut) and "
                   "configure anew, or give --gain; --allow-unstable mills all the same",
                   limit.stable, limit.safe);
}

/// The faults of the status words, in words. A fault of the node comes to the core as one "reported
/// by the caller", which is left out beside it.
std::string faults_of(std::uint32_t status, std::uint16_t node_status) {
  if ((node_status & kNodeFaultBits) != 0) {
    status &= ~static_cast<std::uint32_t>(kExternalFault);
  }
  std::string text;
  for (std::uint32_t bit = 1; (bit & kFaultBits) != 0; bit <<= 1) {
    if ((status & bit) != 0) {
      text += fmt::format("{}{}", text.empty() ? "" : ", ", describe(static_cast<StatusBit>(bit)));
    }
    if ((node_status & kNodeFaultBits & bit) != 0) {
      text += fmt::format("{}{}", text.empty() ? "" : ", ", describe(static_cast<NodeBit>(bit)));
    }
  }
  return text.empty() ? "no fault reported" : text;
}

/// Warns of what went on but should not have.
void warn(const PlantOptions& options, const GainLimit& limit, const simulation::PlantRun& run) {
  if (run.gain > limit.safe * (1 + 1e-6)) {
    fmt::print(stderr, "flexcomp: {}: the gain {:.4g} is {} above the largest safe one, {:.4g}\n",
               options.path, run.gain, run.gain > limit.stable ? "unstable," : "stable but",
               limit.safe);
  }
  if (run.was_lost) {
    fmt::print(stderr, "flexcomp: {}: the correction did not last, it faded out on the way: {}\n",
               options.path, faults_of(run.status, run.node_status));
  }
}

nlohmann::ordered_json summary(const simulation::PlantRun& run) {
  return {{"ticks", run.ticks},
          {"unanswered", run.unanswered},
          {"armed", run.armed},
          {"unstable", run.is_unstable},
          {"lost", run.was_lost},
          {"arm_reply", describe_reply(run.arm_reply)},
          {"largest_gain", run.largest_gain},
          {"status", run.status},
          {"node_status", run.node_status},
          {"least_engagement", run.least_engagement},
          {"most_engagement", run.most_engagement}};
}

/// The model that the compensator needs: with link encoders the joint springs are the controller's.
model::Chain compensated_model(const PlantOptions& options, const model::Robot& robot) {
  return options.arc ? simulation::without_joint_springs(robot.elastic) : robot.elastic;
}

/// The robot moving under a controller that knows the nominal one, with the design's payload.
/// Gravity is that of robot.yaml, so that tables and plant agree.
std::unique_ptr<simulation::RobotInCut> dynamic_robot(const PlantOptions& options,
                                                      const model::Robot& robot) {
  control::ArcRequest request = control::read_arc_request(options.dynamic, robot);
  request.arm.model.gravity = robot.elastic.gravity;
  const control::ArcDesign<6> design =
      control::design_arc<6>(request.arm, request.uncertainty, request.motion, request.bandwidth);
  control::Controller<6> controller = control::with_feed_forward<6>(
      request.arm, control::pd_controller<6>(control::matching_pd<6>(design.gains)));
  if (options.arc) {
    const auto arc = std::make_shared<AdaptiveRobustController<double, 6>>(
        control::make_controller(control::arc_parameters(request.arm, design.gains), request.arm));
    controller = [arc](const ArcInput<double, 6>& input) { return arc->tick(input).torque; };
  }
  simulation::FlexibleArm<6> arm = request.arm;
  arm.model = simulation::with_scaled_compliance(request.arm.model, options.compliance_scale);
  return std::make_unique<control::DynamicMillingRobot>(arm, options.process.process, controller,
                                                        options.plant.period, design.gains.period);
}

std::unique_ptr<simulation::RobotInCut> robot_in_cut(const PlantOptions& options,
                                                     const model::Robot& robot) {
  if (!options.dynamic.empty()) {
    return dynamic_robot(options, robot);
  }
  return std::make_unique<simulation::MillingRobot>(
      simulation::with_scaled_compliance(robot.elastic, options.compliance_scale),
      options.process.process);
}

/// The robot with the laws that its file has as formulas.
std::unique_ptr<simulation::RobotInCut> with_laws(const PlantOptions& options,
                                                  const model::Robot& robot,
                                                  std::unique_ptr<simulation::RobotInCut> plain) {
  const auto laws = std::make_shared<effects::RunningLaws>(robot, options.plant.period);
  if (!laws->any()) {
    return plain;
  }
  return std::make_unique<simulation::DisplacedRobot>(
      std::move(plain), [laws](const JointVector<double, 6>& q, const Wrench<double>& wrench) {
        return laws->next(q, wrench);
      });
}

/// The plant as a KUKA with RSI running.
std::unique_ptr<simulation::PlantBus> rsi_controller(const PlantOptions& options) {
  simulation::RsiControllerOptions rsi;
  rsi.period = options.plant.period;
  rsi.type = options.rsi_type;
  rsi.mode = options.rsi_relative ? RsiMode::relative : RsiMode::absolute;
  return simulation::open_rsi_controller(options.rsi, rsi);
}

void refuse_contradictions(const PlantOptions& options) {
  const int peers = !options.bus.empty() + !options.rsi.empty() + !options.table.empty();
  if (peers != 1) {
    throw InputError("expected --bus or --rsi, or --table for a compensator inside this process");
  }
  if (!options.key.empty() && options.bus.empty()) {
    throw InputError("--key authenticates messages on a bus: it needs --bus");
  }
  if (options.arc && options.dynamic.empty()) {
    throw InputError("--arc needs --dynamic: a robot that stands still needs no control");
  }
}

/// The other side of the plant's bus, and the table that a compensator inside holds on to.
struct Peer {
  std::unique_ptr<TableFile> table;
  std::unique_ptr<simulation::PlantBus> bus;
};

/// Connects the plant, and sets the options that depend on the peer. `known`: the robot as the
/// compensator knows it.
Peer open_peer(const PlantOptions& options, const model::Robot& known,
               simulation::PlantOptions* plant) {
  Peer peer;
  if (!options.rsi.empty()) {
    peer.bus = rsi_controller(options);
    plant->obeys = true;
    plant->hold_time = std::numeric_limits<double>::infinity();
  } else if (options.bus.empty()) {
    peer.table = std::make_unique<TableFile>(read_table(options.table, known));
    peer.bus = simulation::make_inner_bus(node_config(options, known), peer.table->table, false);
    plant->lockstep = true;
  } else {
    peer.bus = simulation::open_plant_bus(options.bus, options.key);
  }
  return peer;
}

void print_json(const PlantOptions& options, const GainLimit& limit,
                const simulation::PlantRun& result) {
  nlohmann::ordered_json json = summary(result);
  json["largest_stable_gain"] =
      std::isfinite(limit.stable) ? nlohmann::ordered_json(limit.stable) : nullptr;
  json["largest_safe_gain"] = limit.safe;
  json["process"] = to_json(options.process);
  fmt::print("{}\n", json.dump(2));
}

void print_refusal(const simulation::PlantRun& result) {
  const std::string why = result.arm_reply != 0
                              ? describe_reply(result.arm_reply)
                              : "nothing was refused, but the correction did not become active";
  fmt::print("not armed: {}; largest safe gain {:.4g}\n", why, result.largest_gain);
}

void print_summary(const PlantOptions& options, const GainLimit& limit,
                   const simulation::PlantRun& result) {
  fmt::print("{} ticks, {} without an answer; engagement {:.3f} to {:.3f} of the nominal depth\n",
             result.ticks, result.unanswered, result.least_engagement, result.most_engagement);
  fmt::print("largest safe gain {:.4g}, with a cut {:g} mm deep\n", limit.safe,
             1e3 * options.process.process.depth_of_cut);
}

/// Did the cut become so deep that the tool was stopped? Then it says so.
bool has_run_away(const PlantOptions& options, const simulation::PlantRun& result) {
  constexpr double kStopped = 0.999;  // of the engagement at which the tool is stopped: rounding
  if (options.allow_unstable ||
      result.most_engagement <= kStopped * simulation::RobotInCut::kMostEngagement) {
    return false;
  }
  fmt::print(stderr,
             "flexcomp: {}: the cut became {:g} times as deep as it should be, and was stopped "
             "there, as a spindle would stall: a deeper cut (--depth-of-cut) or less force\n",
             options.path, simulation::RobotInCut::kMostEngagement);
  return true;
}

/// Writes and prints what came of the plant's run; the exit code.
int finish(const PlantOptions& options, const GainLimit& limit,
           const simulation::PlantRun& result) {
  const bool refused = !options.without_compensation && (!result.armed || result.is_unstable);
  if (!refused && !options.out.empty()) {
    recording::write_recording(options.out, result.recording);
  }
  if (result.is_unstable) {
    fmt::print(stderr, "flexcomp: {}: {}\n", options.path, unstable_text(limit));
  }
  if (options.json) {
    print_json(options, limit, result);
  } else if (result.is_unstable) {
    return kDoesNotHold;
  } else if (refused) {
    print_refusal(result);
  } else {
    print_summary(options, limit, result);
  }
  if (refused) {
    return kDoesNotHold;
  }
  const bool ran_away = has_run_away(options, result);
  warn(options, limit, result);
  return ran_away ? kDoesNotHold : kDone;
}

int run(const PlantOptions& options) {
  refuse_contradictions(options);
  const model::Robot robot = load_robot(options.model);
  const RobotModel<double, 6> elastic = model::six_axis_model(robot);
  model::Robot known = robot;
  known.elastic = compensated_model(options, robot);
  simulation::PlantOptions plant_options = options.plant;
  plant_options.compensate = !options.without_compensation;
  plant_options.model_hash = model_hash(model::six_axis_model(known));
  const Peer peer = open_peer(options, known, &plant_options);
  const recording::Recording path = recording::read_recording(options.path);
  const GainLimit limit = gain_limit_of(options, known, path);
  simulation::Contour contour(elastic, path, options.process.process.side);
  if (!options.allow_unstable && limit.digs_in()) {
    fmt::print(stderr, "flexcomp: {}: {}\n", options.path, unstable_text(limit));
    return kDoesNotHold;
  }
  plant_options.gain = options.gain;
  if (!options.allow_unstable) {
    plant_options.stable_gain = limit.stable;
  }
  simulation::Plant plant(with_laws(options, robot, robot_in_cut(options, robot)),
                          std::move(contour), plant_options, peer.bus.get());
  Progress progress("milling", 1000);
  return finish(options, limit, plant.run([&](double share) {
    progress.show(static_cast<std::size_t>(1000 * share));
  }));
}

/// A controller stops the robot in the midst of a cut: then there is no contour to write.
int run_until_stopped(const PlantOptions& options) {
  try {
    return run(options);
  } catch (const simulation::RsiStopped& stopped) {
    fmt::print(stderr, "flexcomp: {}: {}\n", options.path, stopped.what());
    return kDoesNotHold;
  }
}

}  // namespace

void add_plant(CLI::App* app, Action* action) {
  auto options = std::make_shared<PlantOptions>();
  CLI::App* command = app->add_subcommand(
      "plant",
      "The flexible robot cutting a contour, on the other side of the bus: sends setpoints and "
      "what\n"
      "its force sensor and a tracker measure, and moves by what flexcompd sends back. A deeper "
      "cut\n"
      "gives more force. Laws that the model has as formulas (effects: - {effect: law, …}) move "
      "its\n"
      "TCP too. With --table the compensator runs inside this process, in lock-step: the\n"
      "same code and frames without a bus. Exit code 1 if the compensator refuses to arm, or if "
      "with\n"
      "its gain and this process the loop is unstable.\n"
      "Example: flexcomp plant --model robot.yaml --path path.csv --bus can:vcan0 --out run.csv");
  add_robot(command, &options->model)->required();
  command->add_option("--path", options->path, "recording with t, q_cmd and the nominal wrench")
      ->required();
  command->add_option("--bus", options->bus, "can:INTERFACE, canfd:INTERFACE or lcm:URL");
  command->add_option("--rsi", options->rsi,
                      "udp://ADDRESS:PORT where flexcompd --rsi listens: the plant is a KUKA whose "
                      "RSI sends its\ntelegrams there, arms by an output, and stops where too many "
                      "answers are late (exit code 1)");
  command->add_option("--rsi-type", options->rsi_type,
                      "with --rsi: SENTYPE; answers of another are not taken");
  command->add_flag("--rsi-relative", options->rsi_relative,
                    "with --rsi: takes corrections as what is added each cycle");
  command->add_option("--key", options->key,
                      "file with a key of 32 hexadecimal digits: take and send only messages that "
                      "are\nauthenticated with it, as flexcompd --key does (CAN only)");
  command->add_option("--table", options->table, "table for a compensator inside this process");
  command
      ->add_option("--gain", options->gain,
                   "of the compensator inside; on a bus the largest that it may have")
      ->check(CLI::Range(0.0, 1.0));
  command
      ->add_option("--filter-cutoff", options->filter_cutoff,
                   "Hz, of the compensator, inside or on the bus")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--out", options->out, "recording of the contour to write");
  command
      ->add_option(
          "--period", options->plant.period,
          "s, from one setpoint to the next; with --dynamic a multiple of the design's period")
      ->check(CLI::Range(1e-4, 0.1));
  command->add_flag("--lockstep", options->plant.lockstep,
                    "as fast as answers come, not in real time");
  command->add_flag("--without-compensation", options->without_compensation,
                    "do not arm, and ignore what comes back");
  add_process(command, &options->process);
  command->remove_option(command->get_option("--no-process"));  // it is the process that is cut
  command->add_flag("--allow-unstable", options->allow_unstable,
                    "mill although the correction and the process make an unstable loop");
  command
      ->add_option("--compliance-scale", options->compliance_scale,
                   "all springs this many times as soft: a robot that is not as its model says")
      ->check(CLI::PositiveNumber);
  command->add_option("--dynamic", options->dynamic,
                      "design file (flexcomp design-arc): links and motors with their inertia on "
                      "springs, the motors under a servo with feed-forward; otherwise at rest at "
                      "every moment. Gravity is robot.yaml's");
  command->add_flag("--arc", options->arc,
                    "with --dynamic: the joints under adaptive robust control with encoders on the "
                    "links; the table must be that of the robot with joint compliances of zero");
  command->add_option("--force-noise", options->plant.force_noise, "N, standard deviation")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--moment-noise", options->plant.moment_noise, "N·m, standard deviation")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--seed", options->plant.seed, "of the noise");
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([=] { *action = [=] { return run_until_stopped(*options); }; });
}

}  // namespace flexcomp::cli
