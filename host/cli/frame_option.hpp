#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <vector>

#include "flexcomp/types.hpp"

namespace flexcomp::cli {

/// Adds --frame, a work frame in the robot base frame.
CLI::Option* add_frame(CLI::App* command, std::vector<double>* frame);

/// The frame of such an option; nothing if it was not given. Throws InputError for another count
/// than three or six numbers.
std::optional<Pose<double>> frame_of(const std::vector<double>& numbers);

/// x, y, z (m), roll, pitch, yaw (rad) of a frame.
std::array<double, 6> frame_numbers(const Pose<double>& frame);

}  // namespace flexcomp::cli
