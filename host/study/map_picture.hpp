#pragma once

#include <string>
#include <vector>

#include "study/circularity_map.hpp"

namespace flexcomp::study {

/// A gnuplot script of a map: circularity by colour and contours, how far the arm could reach
/// without joint limits, the robot's first joints, and the best squares.
std::string map_script(const CircularityMap& map, const PlanarArm& arm,
                       const std::vector<BestSquare>& squares, const std::string& title);

}  // namespace flexcomp::study
