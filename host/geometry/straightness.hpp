#pragma once

#include "geometry/circularity.hpp"

namespace flexcomp::geometry {

/// Form error of a profile about one of the reference lines of ISO 12780-1, across that line.
struct Straightness {
  Eigen::Vector2d point;      ///< on the reference line
  Eigen::Vector2d direction;  ///< unit
  double low;                 ///< least deviation, to the left of the direction
  double high;                ///< largest deviation
  /// The points that fix a minimum zone, as indices: two on one side, one between them on the
  /// other. For least squares, which all points fix, the two that deviate most.
  std::vector<std::size_t> support;

  double value() const { return high - low; }
};

/// Both throw InputError for a point that is not finite or fewer than two distinct points.

/// LSLI: the line with the least sum of squared distances, by the principal axis. O(n).
Straightness least_squares_straightness(const Points& points);

/// MZLI: the two parallel lines that are closest and hold all points between them: one of them goes
/// along an edge of the convex hull (Houle and Toussaint 1988). Exact, O(n log n).
Straightness minimum_zone_straightness(const Points& points);

}  // namespace flexcomp::geometry
