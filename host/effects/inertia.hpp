#pragma once

#include "model/robot.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "simulation/scene.hpp"

namespace flexcomp::effects {

/// Inertia (kg·m²) about a joint, or mass (kg) along one that slides, of all that it carries, in a
/// posture; the other joints stand.
double carried_inertia(const model::Robot& robot, const simulation::JointValues& q, int joint);

/// The inertia that a joint carries at every row of a scene.
Eigen::VectorXd carried_inertia(const model::Robot& robot, const simulation::Scene& scene,
                                int joint);

}  // namespace flexcomp::effects
