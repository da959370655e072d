#include "effects/inertia.hpp"

namespace flexcomp::effects {
namespace {

using Row = simulation::JointValues;

model::Robot without_gravity(model::Robot robot) {
  robot.elastic.gravity.setZero();
  return robot;
}

double inertia_at(const model::Robot& weightless, const Row& q, int joint) {
  return simulation::inverse_dynamics(weightless, q, Row::Zero(q.size()),
                                      Row::Unit(q.size(), joint - 1))[joint - 1];
}

}  // namespace

double carried_inertia(const model::Robot& robot, const Row& q, int joint) {
  return inertia_at(without_gravity(robot), q, joint);
}

Eigen::VectorXd carried_inertia(const model::Robot& robot, const simulation::Scene& scene,
                                int joint) {
  const model::Robot weightless = without_gravity(robot);
  Eigen::VectorXd inertia(scene.rows());
  for (Eigen::Index row = 0; row < scene.rows(); ++row) {
    inertia[row] = inertia_at(weightless, scene.q.row(row).transpose(), joint);
  }
  return inertia;
}

}  // namespace flexcomp::effects
