#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/search/search.hpp"
#include "statistics/quantile.hpp"

namespace flexcomp::diagnosis {
namespace {

constexpr double kMostSizes = 0.99;  // of the measured ones: beyond them noise may be
constexpr double kBeyondNoise = 3;   // deviations

/// The size (N·m) that most of a joint's measured torques stay below.
double largest_size(const Observations& observations, int joint) {
  std::vector<double> sizes;
  for (const Scene& scene : observations.scenes) {
    for (const double torque : scene.measured[simulation::joint_torque].col(joint - 1)) {
      if (std::isfinite(torque)) {
        sizes.push_back(std::abs(torque));
      }
    }
  }
  return statistics::quantile(std::move(sizes), kMostSizes);
}

/// Needs torques of a robot that moves.
bool prepare_torque_limit(const Observations& observations, Hypothesis* hypothesis) {
  if (!sees_moving_torques(observations)) {
    return false;
  }
  const double size = largest_size(observations, hypothesis->joint);
  hypothesis->set_bounds({{0.5 * size, 1.5 * size, 0.01 * size}});
  return size > 0;
}

/// Where a limit was reached, the largest sizes that are measured lie near it, and larger ones are
/// predicted.
std::vector<Values> seek_torque_limit(const Observations& observations,
                                      const Eigen::VectorXd& unexplained,
                                      const Hypothesis& hypothesis) {
  const double size = largest_size(observations, hypothesis.joint);
  for (Eigen::Index i = 0; i < observations.train; ++i) {
    const Sample& at = observations.samples[static_cast<std::size_t>(i)];
    if (at.channel != simulation::joint_torque || at.component != hypothesis.joint - 1) {
      continue;
    }
    const double measured =
        observations.scenes[at.scene].measured[at.channel](at.row, at.component);
    const double predicted = measured - unexplained[i] * observations.noise[i];
    if (std::abs(predicted) > size + kBeyondNoise * observations.noise[i]) {
      return {{size}};
    }
  }
  return {};
}

}  // namespace

Search search::torque_limit() { return {prepare_torque_limit, seek_torque_limit}; }

}  // namespace flexcomp::diagnosis
