#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "flexcomp/loop_gain.hpp"
#include "simulation/milling.hpp"

namespace flexcomp::cli {

/// The process that a command assumes, unless told: a cut 2 mm deep with the material outside the
/// path, corrected by flexcompd with its own defaults. No depth is right for every job: commands
/// say which one they assumed.
struct ProcessOptions {
  simulation::Process process;
  CorrectionLoop loop;
  bool is_none = false;  ///< the force does not answer the depth: nothing to analyse

  ProcessOptions();
};

/// --depth-of-cut, --material and --no-process.
void add_process(CLI::App* command, ProcessOptions* options);

/// --loop-period, --loop-filter-cutoff and --loop-delay, of the controller that a gain is for.
void add_loop(CLI::App* command, CorrectionLoop* loop);

/// "a cut 2 mm deep, …": what a table states.
std::string describe(const GainBasis& basis);

/// "a cut 2 mm deep, material outside, …"; what the loop assumes too.
std::string describe(const ProcessOptions& options);

/// Why no gain is safe, and what to do: "the tool digs in by itself, …".
std::string describe_digging_in(const GainLimit& limit);

/// Says how deep the cut becomes without the correction.
std::string describe_fading(const GainLimit& limit);

/// depth_of_cut, material, loop_period, loop_filter_cutoff, loop_delay; null without a process.
nlohmann::ordered_json to_json(const ProcessOptions& options);

}  // namespace flexcomp::cli
