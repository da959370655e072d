#pragma once

#include <optional>
#include <vector>

#include "simulation/machine.hpp"

namespace flexcomp::effects {

using simulation::Machine;
using simulation::Scene;

/// Temperature (°C) at a scene's beginning: where a straight line through its first rows begins,
/// which is less noisy than one value, and no warmer than the beginning as their mean would be.
double first_temperature(const Scene& scene);

/// Rise of the temperature (K) at every row, beyond the reference (°C) or, without one, since the
/// beginning. A recording that is yet to be made has no temperature, and no rise.
Eigen::VectorXd warming(const Scene& scene, const std::optional<double>& reference);

/// The robot holding its numbers for good where the first of the scenes begins, if it does not say
/// where they hold and the scene has temperatures: other recordings may begin warmer.
model::Robot with_reference_temperature(model::Robot robot, const std::vector<Scene>& scenes);

}  // namespace flexcomp::effects
