#pragma once

#include "model/robot.hpp"
#include "simulation/scene.hpp"

namespace flexcomp::effects {

/// Inertia (kg·m²) about a joint of all that it carries, in a posture; the other joints stand.
double carried_inertia(const model::Robot& robot, const JointVector<double, 6>& q, int joint);

/// The same at every row of a scene.
Eigen::VectorXd carried_inertia(const model::Robot& robot, const simulation::Scene& scene,
                                int joint);

}  // namespace flexcomp::effects
