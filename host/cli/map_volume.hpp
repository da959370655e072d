#pragma once

#include <string>

#include "model/robot.hpp"
#include "study/volume_map.hpp"

namespace flexcomp::cli {

/// Runs `flexcomp map --volume`: states the size of the sweep, computes it (going on where an
/// interrupted one ended, shared with the other processes of mpirun), and writes volume.csv and
/// summary.json into a folder. Returns an exit code.
int map_volume(const model::Robot& robot, const study::VolumeRequest& request,
               const std::string& folder, bool json);

}  // namespace flexcomp::cli
