#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "control/path_gain.hpp"

namespace flexcomp::cli {

/// The process that a command assumes, unless told: a cut of 2 mm, the usual depth of a roughing
/// pass in aluminium, with the material outside the path, corrected by flexcompd with its own
/// defaults.
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

/// depth_of_cut, material, loop_period, loop_filter_cutoff, loop_delay; null without a process.
nlohmann::ordered_json to_json(const ProcessOptions& options);

}  // namespace flexcomp::cli
