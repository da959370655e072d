#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace flexcomp::geometry {

using SpacePoints = std::vector<Eigen::Vector3d>;

/// Form error of a surface about one of the reference planes of ISO 12781-1, along its normal.
struct Flatness {
  Eigen::Vector3d point;   ///< on the reference plane
  Eigen::Vector3d normal;  ///< unit
  double low;              ///< least deviation along the normal
  double high;             ///< largest deviation
  /// The points that fix a minimum zone, as indices: three on one side and one on the other, or two
  /// and two. For least squares, which all points fix, the two that deviate most.
  std::vector<std::size_t> support;

  double value() const { return high - low; }
};

/// Both throw InputError for a point that is not finite or points on one line.

/// LSPL: the plane with the least sum of squared distances, by the principal axes. O(n).
Flatness least_squares_flatness(const SpacePoints& points);

/// MZPL: the two parallel planes that are closest and hold all points between them.
///
/// Solved by trying all planes that contacts can fix (Houle and Toussaint 1988) on a few points,
/// adding those that stick out, until none does: the optimum over a part of the points is never
/// wider than that over all, so when the two agree neither can be beaten. O(n) a round.
Flatness minimum_zone_flatness(const SpacePoints& points);

}  // namespace flexcomp::geometry
