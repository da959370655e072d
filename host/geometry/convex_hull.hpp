#pragma once

#include "geometry/circularity.hpp"

namespace flexcomp::geometry {

/// Twice the area that two vectors span, above zero where `b` is counterclockwise of `a`.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Corners of the convex hull, counterclockwise, as indices (Andrew's monotone chain, 1979);
/// O(n log n). Finite points, not all of them the same.
std::vector<std::size_t> convex_hull(const Points& points);

}  // namespace flexcomp::geometry
