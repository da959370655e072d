#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "cli/command.hpp"
#include "cli/number_options.hpp"
#include "cli/plant_result.hpp"
#include "cli/progress.hpp"
#include "cli/table_file.hpp"
#include "control/arc_parameters.hpp"
#include "control/arc_request.hpp"
#include "control/dynamic_milling.hpp"
#include "control/path_gain.hpp"
#include "effects/running_laws.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "node/default_config.hpp"
#include "recording/plausible_angles.hpp"
#include "simulation/displaced_robot.hpp"
#include "simulation/rsi_controller.hpp"

namespace flexcomp::cli {
namespace {

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
  return finish_plant(options, limit, plant.run([&](double share) {
    progress.show(static_cast<std::size_t>(1000 * share));
  }));
}

std::string peer_of(const PlantOptions& options) {
  return !options.rsi.empty() ? options.rsi : !options.bus.empty() ? options.bus : options.table;
}

/// A controller stops the robot in the midst of a cut, or nobody is there: then there is no contour
/// to write.
int run_until_stopped(const PlantOptions& options) {
  try {
    return run(options);
  } catch (const simulation::RsiStopped& stopped) {
    fmt::print(stderr, "flexcomp: {}: {}\n", options.path, stopped.what());
    return kDoesNotHold;
  } catch (const simulation::NobodyAnswers& silence) {
    fmt::print(stderr, "flexcomp: {}: {}\n", peer_of(options), silence.what());
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
      ->check(zero_or_above());
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
      ->check(above_zero());
  command->add_option("--dynamic", options->dynamic,
                      "design file (flexcomp design-arc): links and motors with their inertia on "
                      "springs, the motors under a servo with feed-forward; otherwise at rest at "
                      "every moment. Gravity is robot.yaml's");
  command->add_flag("--arc", options->arc,
                    "with --dynamic: the joints under adaptive robust control with encoders on the "
                    "links; the table must be that of the robot with joint compliances of zero");
  command->add_option("--force-noise", options->plant.force_noise, "N, standard deviation")
      ->check(zero_or_above());
  command->add_option("--moment-noise", options->plant.moment_noise, "N·m, standard deviation")
      ->check(zero_or_above());
  command->add_option("--seed", options->plant.seed, "of the noise");
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([=] { *action = [=] { return run_until_stopped(*options); }; });
}

}  // namespace flexcomp::cli
