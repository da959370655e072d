#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "simulation/scene.hpp"

namespace flexcomp::diagnosis {

/// Time along a picture's axis, s. Times since an epoch count from the first row: gnuplot tells too
/// few of their digits apart.
inline Eigen::VectorXd shown_time(const simulation::Scene& scene) {
  constexpr double kLong = 1e6;  // s: no recording begins so late after its clock
  const double begin = std::abs(scene.time[0]) < kLong ? 0 : scene.time[0];
  return (scene.time.array() - begin).matrix();
}

/// gnuplot takes no range without a width, as that of a single row: then it takes its own.
inline std::string range_of(const Eigen::VectorXd& time) {
  const double first = time[0];
  const double last = time[time.size() - 1];
  return last > first ? fmt::format("set xrange [{:.6g}:{:.6g}]\n", first, last) : "";
}

}  // namespace flexcomp::diagnosis
