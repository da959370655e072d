#pragma once

#include <functional>

#include "error.hpp"
#include "model/chain_kinematics.hpp"

namespace flexcomp::simulation {

using model::JointValues;

/// Deflection of every spring of a robot, each in its own frame (m, rad); at first nothing.
struct Springs {
  Twist<double> base = Twist<double>::Zero();
  JointValues windup;
  model::PerJoint<Twist<double>> link;
  Twist<double> tool = Twist<double>::Zero();

  explicit Springs(const model::Chain& chain)
      : windup(JointValues::Zero(chain.size())), link(chain.joints.size(), Twist<double>::Zero()) {}
};

/// Where a loaded robot stands.
struct Equilibrium {
  Pose<double> tcp;    ///< base frame
  JointValues q_link;  ///< rad, motor angles plus wind-up
};

/// A load under which the robot does not come to rest.
class NoRest : public InputError {
 public:
  using InputError::InputError;
};

/// The flexible robot at rest with its motors at `q_motor` (rad), under a wrench on the tool at the
/// TCP (base frame) and, with gravity in the model, its weights.
///
/// All springs give as in the model, with every lever taken in the bent posture: the equilibrium
/// itself, not its linearisation, found by repeated substitution until no spring gives by more than
/// `tolerance` (rad, m) more. Throws NoRest if the springs are so soft that there is no
/// equilibrium nearby.
Equilibrium settle(const model::Chain& chain, const JointValues& q_motor,
                   const Wrench<double>& wrench, double tolerance = 1e-13);

/// Torques (N·m) in parallel to the drives, on the joints' springs, by the links' angles.
using Balance = std::function<JointValues(const JointValues& q_link)>;

/// The equilibrium, sought from what the springs gave in a state nearby, like the one before.
/// `springs` holds what they give in this one afterwards. `balance` may be left out.
Equilibrium settle_from(const model::Chain& chain, const JointValues& q_motor,
                        const Wrench<double>& wrench, double tolerance, Springs* springs,
                        const Balance& balance = {});

/// A chain, or a model of the core, with all of its springs `factor` times as soft.
template <typename Model>
Model with_scaled_compliance(Model model, double factor) {
  for (auto& joint : model.joints) {
    joint.compliance *= factor;
    joint.cubic_compliance *= factor;
    joint.link_compliance *= factor;
  }
  model.base_compliance *= factor;
  model.tool_compliance *= factor;
  return model;
}

/// A chain, or a model of the core, with stiff joints: only what encoders on the links do not see
/// bends.
template <typename Model>
Model without_joint_springs(Model model) {
  for (auto& joint : model.joints) {
    joint.compliance = 0;
    joint.cubic_compliance = 0;
  }
  return model;
}

}  // namespace flexcomp::simulation
