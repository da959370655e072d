#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace flexcomp::geometry {

using Points = std::vector<Eigen::Vector2d>;

/// Form error of a closed profile about one of the reference circles of ISO 12181-1.
struct Circularity {
  Eigen::Vector2d center;
  double r_min;  ///< distance of the nearest point from the centre
  double r_max;  ///< distance of the farthest
  /// The points that fix the centre, as indices: a certificate anyone can check. For LSC, which all
  /// points fix, the nearest and the farthest.
  std::vector<std::size_t> inner_support;
  std::vector<std::size_t> outer_support;

  double value() const { return r_max - r_min; }
};

/// The four below throw InputError for a point that is not finite, fewer than three distinct
/// points, or points on one line. They are exact to rounding, global (where there are local optima
/// the best is found), and at home with repeated points and coordinates far from the origin.

/// LSC: the centre of the circle with the least sum of squared distances, by Newton–Raphson from
/// the algebraic fit (Klimchik et al. 2017, eqs. 13 and 14). O(n) a step, a handful of steps.
Circularity least_squares_circularity(const Points& points);

/// MZC: the centre for which the two concentric circles that enclose all points are closest. Among
/// centres at a finite distance: a short arc may lie between two parallel lines that are closer.
///
/// The problem is solved by trying all candidates on a few points, adding those it left out, until
/// none is left out: the optimum over a part of the points is never wider than that over all, so
/// when the two agree neither can be beaten. O(n) a round, some ten rounds.
Circularity minimum_zone_circularity(const Points& points);

/// MIC: the centre of the largest circle that holds no point and whose centre lies in the convex
/// hull of the points. Solved as the minimum zone is; the hull costs O(n log n).
Circularity maximum_inscribed_circularity(const Points& points);

/// MCC: the centre of the smallest circle that encloses all points (Welzl 1991), O(n) expected.
Circularity minimum_circumscribed_circularity(const Points& points);

}  // namespace flexcomp::geometry
