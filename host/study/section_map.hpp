#pragma once

#include <functional>

#include "study/circularity_map.hpp"

namespace flexcomp::study {

/// The map of circles that lie across the tool, their centres in the plane y = 0, where the arm of
/// `planar_arm` could reach: by general inverse kinematics, so that the hand may stand at any
/// angle.
///
/// `tool_axis`: where the TCP's z axis points, base frame. The TCP follows the circle and takes the
/// force, whatever `circle.point` says. `progress` is told: rows done, of how many.
/// Throws InputError as `map_circularity` and `VolumeMap` do.
CircularityMap map_section(const RobotModel<double, 6>& model, const MilledCircle& circle,
                           const Vector3<double>& tool_axis, double step,
                           const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace flexcomp::study
