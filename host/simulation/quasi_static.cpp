#include "simulation/quasi_static.hpp"

#include <cmath>

namespace flexcomp::simulation {
namespace {

using model::Chain;
using model::ChainJoint;

/// Frames of the bent robot, base to tip: after each joint moved, and after its link gave.
struct BentChain {
  model::PerJoint<Pose<double>> stiff;  ///< link frames before the link springs give
  model::PerJoint<Pose<double>> bent;   ///< and after
  Pose<double> flange;                  ///< tool frame before the tool springs give
  Pose<double> tcp;
};

/// A frame moved by a twist given in that frame. Most springs are not there, and give nothing.
Pose<double> given_way(const Pose<double>& frame, const Twist<double>& twist) {
  return twist.isZero(0) ? frame : frame * displaced(Pose<double>{}, twist);
}

BentChain bend(const Chain& chain, const JointValues& q_motor, const Springs& springs) {
  BentChain bent;
  Pose<double> frame = given_way(Pose<double>{}, springs.base);
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    frame = moved(frame * chain.joints[i].origin, chain.joints[i],
                  q_motor[joint] + springs.windup[joint]);
    bent.stiff.push_back(frame);
    frame = given_way(frame, springs.link[i]);
    bent.bent.push_back(frame);
  }
  bent.flange = frame * chain.tool;
  bent.tcp = given_way(bent.flange, springs.tool);
  return bent;
}

/// Force and moment about the base origin of all that acts beyond a cut.
struct Load {
  Vector3<double> force;
  Vector3<double> moment;

  void add_weight(double mass, const Vector3<double>& center, const Vector3<double>& gravity) {
    force += mass * gravity;
    moment += center.cross(mass * gravity);
  }

  /// The load as a wrench at a frame's origin, in that frame.
  Wrench<double> at(const Pose<double>& frame) const {
    Wrench<double> wrench;
    wrench << frame.rotation.transpose() * force,
        frame.rotation.transpose() * (moment - frame.position.cross(force));
    return wrench;
  }
};

/// `held`: torques on the joints' springs, in parallel to the drives.
Springs load_springs(const Chain& chain, const BentChain& bent, const Wrench<double>& wrench,
                     const JointValues& held) {
  Springs springs(chain);
  const Vector3<double> force = wrench.head<3>();
  Load load{force, wrench.tail<3>() + bent.tcp.position.cross(force)};
  load.add_weight(chain.payload_mass, bent.tcp.position + bent.tcp.rotation * chain.payload_center,
                  chain.gravity);
  // The tool's spring forces are those at the TCP, where the wrench is given.
  if (!chain.tool_compliance.isZero(0)) {
    springs.tool =
        chain.tool_compliance.cwiseProduct(load.at({bent.flange.rotation, bent.tcp.position}));
  }
  for (std::size_t i = chain.joints.size(); i-- > 0;) {
    const ChainJoint& joint = chain.joints[i];
    load.add_weight(joint.mass,
                    bent.bent[i].position + bent.bent[i].rotation * joint.center_of_mass,
                    chain.gravity);
    if (!joint.link_compliance.isZero(0)) {
      springs.link[i] = joint.link_compliance.cwiseProduct(load.at(bent.stiff[i]));
    }
    const Pose<double>& frame = bent.stiff[i];
    const auto at = static_cast<Eigen::Index>(i);
    const double torque = held[at] + joint_load(joint, frame.rotation * joint.axis, load.force,
                                                load.moment - frame.position.cross(load.force));
    springs.windup[at] = (joint.compliance + joint.cubic_compliance * torque * torque) * torque;
  }
  springs.base = chain.base_compliance.cwiseProduct(load.at(Pose<double>{}));
  return springs;
}

double largest_change(const Springs& from, const Springs& to) {
  double change = (to.windup - from.windup).cwiseAbs().maxCoeff();
  change = std::fmax(change, (to.base - from.base).cwiseAbs().maxCoeff());
  change = std::fmax(change, (to.tool - from.tool).cwiseAbs().maxCoeff());
  for (std::size_t i = 0; i < to.link.size(); ++i) {
    change = std::fmax(change, (to.link[i] - from.link[i]).cwiseAbs().maxCoeff());
  }
  return change;
}

}  // namespace

Equilibrium settle(const Chain& chain, const JointValues& q_motor, const Wrench<double>& wrench,
                   double tolerance) {
  Springs springs(chain);
  return settle_from(chain, q_motor, wrench, tolerance, &springs);
}

Equilibrium settle_from(const Chain& chain, const JointValues& q_motor,
                        const Wrench<double>& wrench, double tolerance, Springs* springs,
                        const Balance& balance) {
  constexpr int kMaxRounds = 200;
  for (int round = 0; round < kMaxRounds; ++round) {
    const BentChain bent = bend(chain, q_motor, *springs);
    const JointValues held =
        balance ? balance(q_motor + springs->windup) : JointValues::Zero(q_motor.size());
    const Springs next = load_springs(chain, bent, wrench, held);
    const double change = largest_change(*springs, next);
    *springs = next;
    if (change <= tolerance) {
      return {bent.tcp, q_motor + springs->windup};
    }
    if (!std::isfinite(change) || change > 10) {
      break;
    }
  }
  throw NoRest("the robot does not come to rest under this load: its springs are too soft");
}

}  // namespace flexcomp::simulation
