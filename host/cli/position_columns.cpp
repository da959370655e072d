#include "cli/position_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error.hpp"

namespace flexcomp::cli {
namespace {

std::size_t column_index(const recording::NumberTable& table, const std::string& name) {
  const auto found = std::find(table.columns.begin(), table.columns.end(), name);
  if (found == table.columns.end()) {
    throw InputError(fmt::format("{}:1: column '{}' is missing", table.file, name));
  }
  return static_cast<std::size_t>(found - table.columns.begin());
}

}  // namespace

std::array<std::string, 2> plane_columns(const recording::NumberTable& table,
                                         const std::vector<std::string>& asked) {
  if (asked.size() == 2) {
    return {asked[0], asked[1]};
  }
  std::vector<std::string> positions;
  for (const char* name : {"x", "y", "z"}) {
    if (std::count(table.columns.begin(), table.columns.end(), name) > 0) {
      positions.emplace_back(name);
    }
  }
  if (positions.size() != 2) {
    throw InputError(fmt::format("{}:1: {} of the columns x, y, z; say which two with --columns",
                                 table.file, positions.size()));
  }
  return {positions[0], positions[1]};
}

geometry::Points points_in(const recording::NumberTable& table,
                           const std::array<std::string, 2>& columns) {
  const std::size_t first = column_index(table, columns[0]);
  const std::size_t second = column_index(table, columns[1]);
  geometry::Points points;
  for (const std::vector<double>& row : table.rows) {
    const Eigen::Vector2d point(row[first], row[second]);
    if (point.allFinite()) {
      points.push_back(point);
    }
  }
  return points;
}

geometry::SpacePoints points_in_space(const recording::NumberTable& table) {
  const std::size_t x = column_index(table, "x");
  const std::size_t y = column_index(table, "y");
  const std::size_t z = column_index(table, "z");
  geometry::SpacePoints points;
  for (const std::vector<double>& row : table.rows) {
    const Eigen::Vector3d point(row[x], row[y], row[z]);
    if (point.allFinite()) {
      points.push_back(point);
    }
  }
  return points;
}

}  // namespace flexcomp::cli
