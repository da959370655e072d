#include "effects/machine_size.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/plausible_range.hpp"

namespace flexcomp::effects {
namespace {

/// m, by which the second joint stands along the axis of the first, which turns it on the spot.
double column_of(const model::Chain& chain) {
  return chain.joints.size() > 1 && !chain.joints[0].slides()
             ? std::abs(chain.joints[0].axis.dot(chain.joints[1].origin.position))
             : 0;
}

}  // namespace

MachineSize size_of(const model::Robot& robot) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  MachineSize size;
  double mass = 0;
  for (std::size_t i = 0; i < robot.elastic.joints.size(); ++i) {
    const model::JointDynamics& limits = robot.dynamics[i];
    const model::ChainJoint& joint = robot.elastic.joints[i];
    mass += joint.mass;
    // The first joint's distance from the base lies below all that moves.
    size.reach += i > 0 ? joint.origin.position.norm() : 0;
    size.reach += joint.slides() ? std::max(std::abs(joint.lower), std::abs(joint.upper)) : 0;
    size.effort.push_back(limits.effort > 0 ? limits.effort : kEndless);
    size.velocity.push_back(limits.velocity > 0 ? limits.velocity : kEndless);
    size.load.push_back(0);
  }
  size.reach += robot.elastic.tool.position.norm();
  size.outreach = size.reach - column_of(robot.elastic);
  size.payload = mass > 0 ? std::max(mass, robot.elastic.payload_mass) : kLargestPayload;
  size.weight = kGravity * mass;
  size.weight_torque = mass > 0 ? 0.5 * size.weight * size.reach : kEndless;
  return size;
}

}  // namespace flexcomp::effects
