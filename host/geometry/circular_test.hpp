#pragma once

#include "geometry/circularity.hpp"

namespace flexcomp::geometry {

/// Result of a circular test: a circle of nominal radius, run both ways (ISO 230-4:2005); m.
struct CircularTest {
  double clockwise = 0;         ///< circular deviation G, of the clockwise path (minimum zone)
  double counterclockwise = 0;  ///< G of the other
  double bidirectional = 0;     ///< G(b): of both paths together
  double hysteresis = 0;        ///< H: the largest distance between them along a radius
  double mean_radial = 0;       ///< D: mean radius of both less the nominal radius
  /// Radial deviations F from the nominal circle about the least-squares centre of both.
  double clockwise_least = 0;
  double clockwise_most = 0;
  double counterclockwise_least = 0;
  double counterclockwise_most = 0;
};

/// Between the points of a path its radius runs straight over the angle. Throws InputError where a
/// path has no reference circle or a radius is not above zero.
CircularTest circular_test(const Points& clockwise, const Points& counterclockwise, double radius);

}  // namespace flexcomp::geometry
