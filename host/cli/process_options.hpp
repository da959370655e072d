#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "control/path_gain.hpp"

namespace flexcomp::cli {

/// The process that a command assumes, unless told: a cut 2 mm deep with the material outside the
/// path, corrected by flexcompd with its own defaults. No depth is right for every job: commands
/// say which one they assumed.
struct ProcessOptions {
  simulation::Process process;
  control::CorrectionLoop loop;
  bool is_none = false;  ///< the force does not answer the depth: nothing to analyse

  ProcessOptions();
};

/// --depth-of-cut, --material and --no-process.
void add_process(CLI::App* command, ProcessOptions* options);

/// "a cut 2 mm deep, material outside, …"; what the loop assumes too.
std::string describe(const ProcessOptions& options);

/// Why no gain is safe, and what to do: "the tool digs in by itself, …".
std::string describe_digging_in(const control::GainLimit& limit);

/// What happens to the cut without the correction.
std::string describe_fading(const control::GainLimit& limit);

/// depth_of_cut, material, loop_period, loop_filter_cutoff, loop_delay; null without a process.
nlohmann::ordered_json to_json(const ProcessOptions& options);

}  // namespace flexcomp::cli
