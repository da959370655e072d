#pragma once

#include <functional>

#include "flexcomp/model.hpp"
#include "recording/recording.hpp"

namespace flexcomp::planning {

/// A circle to be milled.
struct CirclePlan {
  Vector3<double> center;       ///< m, base frame
  Vector3<double> first_axis;   ///< unit, in the plane: where the circle begins
  Vector3<double> second_axis;  ///< unit, in the plane: towards it the angle grows
  double radius = 0.1;          ///< m
  bool clockwise = false;       ///< from the second axis to the first
  int points = 360;             ///< steps of the full circle
  double feed = 0.05;           ///< m/s
  Vector3<double> tool_axis;    ///< unit, where the tool's z axis points
  Vector3<double> force;        ///< N, {radial, along the feed, along the plane's normal}
  Vector3<double> moment;       ///< N·m, in the same directions
};

/// The circle as a recording with t, q_cmd and the wrench, the first point repeated at the end.
///
/// The wrench turns with the path (Klimchik et al. 2017, eq. 15): its first component points out of
/// the circle, its second along the feed, its third along first × second axis. `progress` is called
/// with the points done. Throws InputError where the circle is out of reach or the joints would
/// have to jump.
recording::Recording plan_circle(const RobotModel<double, 6>& model, const CirclePlan& plan,
                                 const std::function<void(int)>& progress);

}  // namespace flexcomp::planning
