#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnosis/search/search.hpp"

namespace flexcomp::diagnosis {
namespace {

/// The size (N·m) of a joint's measured torque that one in so many is beyond.
double size_beyond(const Observations& observations, int joint, Eigen::Index one_in) {
  std::vector<double> sizes;
  for (const Scene& scene : observations.scenes) {
    for (const double torque : scene.measured[simulation::joint_torque].col(joint - 1)) {
      if (std::isfinite(torque)) {
        sizes.push_back(std::abs(torque));
      }
    }
  }
  if (sizes.empty()) {
    return 0;
  }
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size()) - 1 -
                     static_cast<std::ptrdiff_t>(sizes.size()) / one_in;
  std::nth_element(sizes.begin(), place, sizes.end());
  return *place;
}

/// Needs torques of a robot that moves, which are predicted beyond those that were measured. Where
/// a limit was reached, the largest sizes lie near it.
bool prepare_torque_limit(const Observations& observations, Hypothesis* hypothesis) {
  constexpr Eigen::Index kOneIn = 100;  // beyond it noise may be
  const int joint = hypothesis->joint;
  if (!sees_moving_torques(observations)) {
    return false;
  }
  const double size = size_beyond(observations, joint, kOneIn);
  double predicted = 0;
  for (const Prediction& prediction : observations.predictions) {
    predicted =
        std::max(predicted,
                 prediction.channel[simulation::joint_torque].col(joint - 1).cwiseAbs().maxCoeff());
  }
  hypothesis->set_bounds({{0.5 * size, 1.5 * size, 0.01 * size}});
  hypothesis->starts = {{size}};
  return size > 0 && predicted > size;
}

}  // namespace

Search search::torque_limit() { return {prepare_torque_limit}; }

}  // namespace flexcomp::diagnosis
