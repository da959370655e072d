#include "effects/temperature.hpp"

#include <algorithm>

namespace flexcomp::effects {

double first_temperature(const Scene& scene) {
  constexpr Eigen::Index kOneIn = 33;  // rows
  constexpr Eigen::Index kLeast = 3;   // rows that make a line
  const Eigen::Index first = std::max<Eigen::Index>(scene.temperature.size() / kOneIn, 1);
  const double mean = scene.temperature.head(first).mean();
  const Eigen::VectorXd time = scene.time.head(first).array() - scene.time.head(first).mean();
  const double square = time.squaredNorm();
  if (first < kLeast || !(square > 0)) {
    return mean;
  }
  return mean + time.dot(scene.temperature.head(first)) / square * time[0];
}

Eigen::VectorXd warming(const Scene& scene, const std::optional<double>& reference) {
  if (scene.temperature.size() == 0) {
    return Eigen::VectorXd::Zero(scene.rows());
  }
  return scene.temperature.array() - (reference ? *reference : first_temperature(scene));
}

model::Robot with_reference_temperature(model::Robot robot, const std::vector<Scene>& scenes) {
  if (!robot.reference_temperature && scenes.front().temperature.size() > 0) {
    robot.reference_temperature = first_temperature(scenes.front());
  }
  return robot;
}

}  // namespace flexcomp::effects
