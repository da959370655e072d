#include "cli/process_options.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "cli/number_options.hpp"
#include "node/default_config.hpp"

namespace flexcomp::cli {
namespace {

bool is_outside(const ProcessOptions& options) {
  return options.process.side == simulation::MaterialSide::outside;
}

}  // namespace

ProcessOptions::ProcessOptions() {
  const CompensatorConfig<double, 6> node = default_compensator_config<double>();
  loop = {node.period, node.filter_cutoff, node.period};
}

void add_process(CLI::App* command, ProcessOptions* options) {
  command
      ->add_option("--depth-of-cut", options->process.depth_of_cut,
                   "m, nominal: how much deeper the tool is for twice the force")
      ->check(above_zero());
  const std::map<std::string, simulation::MaterialSide> sides = {
      {"outside", simulation::MaterialSide::outside}, {"inside", simulation::MaterialSide::inside}};
  CLI::CheckedTransformer as_side(sides, CLI::ignore_case);
  as_side.description("{outside,inside}");
  command->add_option("--material", options->process.side, "side of the contour")
      ->transform(as_side)
      ->type_name("TEXT")
      ->default_str(is_outside(*options) ? "outside" : "inside");
  command->add_flag("--no-process", options->is_none,
                    "the force does not answer where the tool is (no cut): any gain is stable");
}

void add_loop(CLI::App* command, CorrectionLoop* loop) {
  command->add_option("--loop-period", loop->period, "s, of the controller")->check(above_zero());
  command
      ->add_option("--loop-filter-cutoff", loop->filter_cutoff,
                   "Hz, of the controller's filter on the wrench; 0: none")
      ->check(zero_or_above());
  command
      ->add_option("--loop-delay", loop->delay,
                   "s, from the wrench to the robot standing corrected")
      ->check(zero_or_above());
}

std::string describe(const GainBasis& basis) {
  return fmt::format(
      "a cut {:g} mm deep, into which its force moves the TCP by {:.3g} to {:.3g} mm; ticks every "
      "{:g} ms, filter {:g} Hz, delay {:g} ms",
      1e3F * basis.depth_of_cut, 1e3F * basis.least_push, 1e3F * basis.most_push,
      1e3F * basis.period, basis.filter_cutoff, 1e3F * basis.delay);
}

std::string describe(const ProcessOptions& options) {
  return fmt::format(
      "a cut {:g} mm deep, material {}; ticks every {:g} ms, filter {:g} Hz, delay {:g} ms",
      1e3 * options.process.depth_of_cut, is_outside(options) ? "outside" : "inside",
      1e3 * options.loop.period, options.loop.filter_cutoff, 1e3 * options.loop.delay);
}

std::string describe_digging_in(const GainLimit& limit) {
  constexpr const char* kRemedy =
      "give the depth of your cut (--depth-of-cut) and its side (--material), or less force";
  return std::isfinite(limit.engagement)
             ? fmt::format("with it the cut would become {:.2g} times as deep; {}",
                           limit.engagement, kRemedy)
             : fmt::format("the tool digs in by itself; {}", kRemedy);
}

std::string describe_fading(const GainLimit& limit) {
  return fmt::format("should the correction fade out, the cut becomes {:.2g} times as deep",
                     limit.engagement_without);
}

nlohmann::ordered_json to_json(const ProcessOptions& options) {
  if (options.is_none) {
    return nullptr;
  }
  return {{"depth_of_cut", options.process.depth_of_cut},
          {"material", is_outside(options) ? "outside" : "inside"},
          {"loop_period", options.loop.period},
          {"loop_filter_cutoff", options.loop.filter_cutoff},
          {"loop_delay", options.loop.delay}};
}

}  // namespace flexcomp::cli
