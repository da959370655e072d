#pragma once

#include <filesystem>

#include "model/robot.hpp"

namespace flexcomp::model {

/// Reads a URDF and fills what it says about the chain from `robot->base_link` to
/// `robot->tool_link`: joint names, geometry, limits, masses, inertias, efforts and velocities.
///
/// Fixed joints between are folded into the joints' origins. All that hangs on a link beside the
/// chain counts as part of it: what is fixed to it, and what moves on it (a gripper's fingers) as
/// it stands at zero.
///
/// Throws InputError naming the file and the link or joint if the file is no URDF, a link is not
/// there, a body is impossible, or there are not 1 to 12 joints between the two links that are
/// revolute, continuous or prismatic, with limits where they end.
void read_urdf_chain(const std::filesystem::path& urdf, Robot* robot);

}  // namespace flexcomp::model
