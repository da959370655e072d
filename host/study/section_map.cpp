#include "study/section_map.hpp"

#include <algorithm>
#include <cmath>

#include "parallel/in_parallel.hpp"
#include "study/volume_map.hpp"

namespace flexcomp::study {

CircularityMap map_section(const RobotModel<double, 6>& model, const MilledCircle& circle,
                           const Vector3<double>& tool_axis, double step,
                           const std::function<void(std::size_t, std::size_t)>& progress) {
  PlanarArm arm = planar_arm(model, ToolPoint::tcp, false);
  // Joint 1 may turn the arm round to the back.
  arm.reach[1] += std::abs(arm.shoulder.real());
  arm.shoulder.real(0);
  CircularityMap map = empty_map(arm, step);
  VolumeRequest request;
  request.lower = {map.x(0), 0, map.z(0)};
  request.upper = {map.x(map.columns - 1), 0, map.z(map.rows - 1)};
  request.step = step;
  request.tool_axes = {tool_axis};
  request.circle = circle;
  const VolumeMap section(model, request);
  in_parallel(section.layers(), progress, [&](std::size_t row) {
    const std::vector<double> values = section.layer(row);
    std::copy(values.begin(), values.end(),
              map.circularity.begin() + static_cast<std::ptrdiff_t>(row) * map.columns);
  });
  return map;
}

}  // namespace flexcomp::study
