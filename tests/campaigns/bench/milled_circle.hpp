#pragma once

#include <cstdint>
#include <vector>

#include "flexcomp/compliance.hpp"
#include "flexcomp/table_builder.hpp"

namespace flexcomp::bench {

/// Input of a control loop, setpoint by setpoint.
template <typename Scalar>
struct Setpoints {
  std::vector<JointVector<Scalar, 6>> q;  ///< rad
  std::vector<Wrench<Scalar>> wrench;     ///< N, N·m; at the TCP, base frame
  std::size_t size() const { return q.size(); }
};

/// A circle of 0.1 m radius that a KR 270 mills at 50 mm/s, the study's wrench turning with it
/// (Klimchik et al. 2017, section 4), a setpoint every 4 ms.
struct MilledCircle {
  RobotModel<double, 6> robot;
  std::vector<JointVector<double, 6>> program;  ///< corners of the polyline in joint space, rad
  Setpoints<double> setpoints;                  ///< on that polyline
};

MilledCircle milled_circle();

/// The same in single precision.
Setpoints<float> in_single_precision(const Setpoints<double>& setpoints);

constexpr double kForceBound = 1750;  ///< N, a tenth above the study's
constexpr double kMomentBound = 12;   ///< N·m

/// A path table of the circle for wrenches within the bounds. `tolerance`: m and rad. Ends the
/// program where it cannot be built.
std::vector<std::uint32_t> path_table(const MilledCircle& circle, double tolerance);

/// A grid table over joints 2 to 5, as `path_table` otherwise.
std::vector<std::uint32_t> grid_table(const RobotModel<double, 6>& robot,
                                      const GridRange<double> (&ranges)[4], double tolerance);

/// The view of a table that was just built.
Table opened(const std::vector<std::uint32_t>& words);

}  // namespace flexcomp::bench
