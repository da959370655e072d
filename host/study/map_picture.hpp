#pragma once

#include <optional>
#include <string>
#include <vector>

#include "study/circularity_map.hpp"

namespace flexcomp::study {

/// A gnuplot script of a map: circularity by colour and contours, the best squares, and, where the
/// map is of one arm, how far that could reach without joint limits.
std::string map_script(const CircularityMap& map, const std::optional<PlanarArm>& arm,
                       const std::vector<BestSquare>& squares, const std::string& title);

}  // namespace flexcomp::study
