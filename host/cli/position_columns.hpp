#pragma once

#include <array>
#include <string>
#include <vector>

#include "geometry/circularity.hpp"
#include "geometry/flatness.hpp"
#include "recording/csv.hpp"

namespace flexcomp::cli {

/// The two columns of a circle's plane: those asked for, or the position columns x, y, z if there
/// are just two. Throws InputError otherwise.
std::array<std::string, 2> plane_columns(const recording::NumberTable& table,
                                         const std::vector<std::string>& asked);

/// The points in two columns; rows where one of them is missing are left out.
geometry::Points points_in(const recording::NumberTable& table,
                           const std::array<std::string, 2>& columns);

/// The points in the columns x, y, z; rows where one of them is missing are left out.
geometry::SpacePoints points_in_space(const recording::NumberTable& table);

}  // namespace flexcomp::cli
