#include "simulation/plant.hpp"

#include <fmt/format.h>

#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/command.hpp"
#include "cli/progress.hpp"
#include "cli/table_file.hpp"
#include "error.hpp"
#include "model/robot.hpp"
#include "node/default_config.hpp"
#include "node/reply.hpp"

namespace flexcomp::cli {
namespace {

struct PlantOptions {
  std::string model;
  std::string path;
  std::string bus;
  std::string table;
  std::string out;
  double compliance_scale = 1;
  double gain = 1;
  double filter_cutoff = 20;
  simulation::Process process;
  simulation::PlantOptions plant;
  bool without_compensation = false;
  bool json = false;
};

NodeConfig node_config(const PlantOptions& options, const model::Robot& robot) {
  NodeConfig config = default_node_config();
  config.compensator.period = static_cast<float>(options.plant.period);
  config.compensator.gain = static_cast<float>(options.gain);
  config.compensator.filter_cutoff = static_cast<float>(options.filter_cutoff);
  config.compensator.model_hash = model_hash(robot.elastic);
  return config;
}

nlohmann::ordered_json summary(const simulation::PlantRun& run) {
  return {{"ticks", run.ticks},
          {"unanswered", run.unanswered},
          {"armed", run.armed},
          {"arm_reply", describe_reply(run.arm_reply)},
          {"largest_gain", run.largest_gain},
          {"status", run.status},
          {"node_status", run.node_status},
          {"least_engagement", run.least_engagement},
          {"most_engagement", run.most_engagement}};
}

int run(const PlantOptions& options) {
  if (options.bus.empty() == options.table.empty()) {
    throw InputError("expected either --bus, or --table for a compensator inside this process");
  }
  const model::Robot robot = model::load_robot(options.model);
  std::unique_ptr<simulation::PlantBus> bus;
  simulation::PlantOptions plant_options = options.plant;
  plant_options.compensate = !options.without_compensation;
  plant_options.model_hash = model_hash(robot.elastic);
  std::unique_ptr<TableFile> table;
  if (options.bus.empty()) {
    table = std::make_unique<TableFile>(read_table(options.table, robot));
    bus = simulation::make_inner_bus(node_config(options, robot), table->table, false);
    plant_options.lockstep = true;
  } else {
    bus = simulation::open_plant_bus(options.bus);
  }
  simulation::Contour contour(robot.elastic, recording::read_recording(options.path),
                              options.process.side);
  simulation::Plant plant(
      simulation::with_scaled_compliance(robot.elastic, options.compliance_scale),
      std::move(contour), options.process, plant_options, bus.get());
  Progress progress("milling", 1000);
  const simulation::PlantRun result =
      plant.run([&](double share) { progress.show(static_cast<std::size_t>(1000 * share)); });
  const bool refused = plant_options.compensate && !result.armed;
  if (!refused && !options.out.empty()) {
    recording::write_recording(options.out, result.recording);
  }
  if (options.json) {
    fmt::print("{}\n", summary(result).dump(2));
  } else if (refused) {
    fmt::print("not armed: {}; largest safe gain {:.4g}\n", describe_reply(result.arm_reply),
               result.largest_gain);
  } else {
    fmt::print("{} ticks, {} without an answer; engagement {:.3f} to {:.3f} of the nominal depth\n",
               result.ticks, result.unanswered, result.least_engagement, result.most_engagement);
  }
  return refused ? kDoesNotHold : kDone;
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
      "gives more force. With --table the compensator runs inside this process, in lock-step: the\n"
      "same code and frames without a bus. Exit code 1 if the compensator refuses to arm.\n"
      "Example: flexcomp plant --model robot.yaml --path path.csv --bus can:vcan0 --out run.csv");
  command->add_option("--model", options->model, "robot.yaml")->required();
  command->add_option("--path", options->path, "recording with t, q_cmd and the nominal wrench")
      ->required();
  command->add_option("--bus", options->bus, "can:INTERFACE, canfd:INTERFACE or lcm:URL");
  command->add_option("--table", options->table, "table for a compensator inside this process");
  command->add_option("--gain", options->gain, "of the compensator inside")
      ->check(CLI::Range(0.0, 1.0));
  command->add_option("--filter-cutoff", options->filter_cutoff, "Hz, of the compensator inside")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--out", options->out, "recording of the contour to write");
  command->add_option("--period", options->plant.period, "s, from one setpoint to the next")
      ->check(CLI::Range(1e-4, 0.1));
  command->add_flag("--lockstep", options->plant.lockstep,
                    "as fast as answers come, not in real time");
  command->add_flag("--without-compensation", options->without_compensation,
                    "do not arm, and ignore what comes back");
  command->add_option("--depth-of-cut", options->process.depth_of_cut, "m, nominal")
      ->check(CLI::PositiveNumber);
  const std::map<std::string, simulation::MaterialSide> sides = {
      {"outside", simulation::MaterialSide::outside}, {"inside", simulation::MaterialSide::inside}};
  command->add_option("--material", options->process.side, "side of the contour: outside or inside")
      ->transform(CLI::CheckedTransformer(sides, CLI::ignore_case));
  command
      ->add_option("--compliance-scale", options->compliance_scale,
                   "all springs this many times as soft: a robot that is not as its model says")
      ->check(CLI::PositiveNumber);
  command->add_option("--force-noise", options->plant.force_noise, "N, standard deviation")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--moment-noise", options->plant.moment_noise, "N·m, standard deviation")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--seed", options->plant.seed, "of the noise");
  command->add_flag("--json", options->json, "print the summary as JSON");
  command->callback([=] { *action = [=] { return run(*options); }; });
}

}  // namespace flexcomp::cli
