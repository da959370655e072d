#pragma once

#include <string>

#include "cli/process_options.hpp"
#include "cli/robot_choice.hpp"
#include "simulation/plant.hpp"

/// What `flexcomp plant` is asked for, and what it says of a run.
namespace flexcomp::cli {

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

/// One line that says which gain would be stable, and how to have it.
std::string unstable_text(const GainLimit& limit);

/// Writes the recording of a run and prints its result; returns the exit code.
int finish_plant(const PlantOptions& options, const GainLimit& limit,
                 const simulation::PlantRun& result);

}  // namespace flexcomp::cli
