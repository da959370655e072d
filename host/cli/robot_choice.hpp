#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "model/robot.hpp"

namespace flexcomp::cli {

/// A robot as a command line names it: its file, and the tool on its flange if it is another than
/// the file's.
struct RobotChoice {
  std::string file;
  std::string tool;  ///< FILE or FILE:NAME of a file of named tools; empty for that of the robot

  bool empty() const { return file.empty(); }
};

/// Adds --model alone, for commands whose --tool is another matter.
CLI::Option* add_model(CLI::App* command, RobotChoice* choice,
                       const std::string& help = "robot.yaml");

/// Adds --model and --tool to a command; returns --model.
CLI::Option* add_robot(CLI::App* command, RobotChoice* choice);

/// Throws InputError as `model::load_robot` and `model::load_tool` do.
model::Robot load_robot(const RobotChoice& choice);

/// The choice as options of a command line, for pages that say how they were made.
std::string describe(const RobotChoice& choice);

}  // namespace flexcomp::cli
