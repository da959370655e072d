#pragma once

#include <vector>

#include "flexcomp/model.hpp"
#include "recording/recording.hpp"

namespace flexcomp::planning {

/// A place on a way.
struct OnWay {
  std::size_t piece = 0;  ///< the straight piece that it is on
  double share = 0;       ///< of that piece
  double off = 0;         ///< m, from what it is nearest to
  double passed = 0;      ///< m, of the way from where it was looked for
};

/// The way of a TCP as straight pieces between points, of which there are two or more.
class Way {
 public:
  explicit Way(std::vector<Vector3<double>> points) : points_(std::move(points)) {}

  /// The place that a point is at which is `step` (m) farther on than `from`, about, and never
  /// behind: the nearest, where going a millimetre too far or too little counts as a tenth of one
  /// beside the way. A way may cross itself or run back on itself, and what follows it is not to
  /// jump. Looks `room` (m) beyond the step.
  OnWay next(const OnWay& from, double step, double room, const Vector3<double>& point) const;

  std::size_t pieces() const { return points_.size() - 1; }

 private:
  OnWay on_piece(std::size_t piece, double least_share, const Vector3<double>& point) const;

  std::vector<Vector3<double>> points_;
};

/// Where the TCP of the stiff robot passes, m.
std::vector<Vector3<double>> places_of(const RobotModel<double, 6>& model,
                                       const recording::Samples& q);

/// How far places are from a way that they follow.
struct ContourError {
  double largest = 0;      ///< m
  double mean_square = 0;  ///< m, its root mean square
  std::size_t row = 0;     ///< of the largest
};

/// Distances from a way of places that follow it in order, looked for `room` (m) ahead.
ContourError contour_error(const Way& way, const recording::Samples& places, double room = 0.01);

}  // namespace flexcomp::planning
