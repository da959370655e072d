#pragma once

#include <array>

#include "flexcomp/types.hpp"

namespace flexcomp::model {

/// x, y, z (m), roll, pitch, yaw (rad) of a frame, as in a URDF.
std::array<double, 6> frame_numbers(const Pose<double>& frame);

/// The frame of such numbers.
Pose<double> frame_of_numbers(const std::array<double, 6>& numbers);

}  // namespace flexcomp::model
