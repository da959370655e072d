#pragma once

#include <filesystem>
#include <string>

#include "model/robot.hpp"

namespace flexcomp::model {

/// Reads a URDF and fills what it says about the chain from `robot->base_link` to
/// `robot->tool_link`: joint names, geometry, limits, masses, inertias, efforts and velocities.
/// Fixed joints between, and bodies fixed beside, are folded into the links that carry them.
///
/// Throws InputError naming the file and the link or joint if the file is no URDF, a link is not
/// there, or there are not exactly six revolute joints with limits between the two.
void read_urdf_chain(const std::filesystem::path& urdf, Robot* robot);

}  // namespace flexcomp::model
