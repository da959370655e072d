#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "flexcomp/types.hpp"

namespace flexcomp::cli {

/// Adds --frame, a work frame in the robot base frame.
CLI::Option* add_frame(CLI::App* command, std::vector<double>* frame);

/// The same for another frame, by its option and what it is.
CLI::Option* add_frame(CLI::App* command, const std::string& name, const std::string& what,
                       std::vector<double>* frame);

/// The frame of such an option; nothing if it was not given. Throws InputError for another count
/// than three or six numbers.
std::optional<Pose<double>> frame_of(const std::vector<double>& numbers,
                                     const std::string& option = "--frame");

}  // namespace flexcomp::cli
