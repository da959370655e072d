#include "simulation/quasi_static.hpp"

#include <array>
#include <cmath>

#include "error.hpp"

namespace flexcomp::simulation {
namespace {

/// Frames of the bent robot, base to tip: before each joint turns, after it, and after its link
/// gave.
struct BentChain {
  std::array<Pose<double>, 6> stiff;  ///< link frames before the link springs give
  std::array<Pose<double>, 6> bent;   ///< and after
  Pose<double> flange;                ///< tool frame before the tool springs give
  Pose<double> tcp;
};

/// A frame moved by a twist given in that frame. Most springs are not there, and give nothing.
Pose<double> given_way(const Pose<double>& frame, const Twist<double>& twist) {
  return twist.isZero(0) ? frame : frame * displaced(Pose<double>{}, twist);
}

BentChain bend(const RobotModel<double, 6>& model, const JointVector<double, 6>& q_motor,
               const Springs& springs) {
  BentChain chain;
  Pose<double> frame = given_way(Pose<double>{}, springs.base);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    frame = frame * model.joints[i].origin;
    frame.rotation = frame.rotation * axis_rotation<double>(model.joints[i].axis,
                                                            q_motor[joint] + springs.windup[joint]);
    chain.stiff[i] = frame;
    frame = given_way(frame, springs.link[i]);
    chain.bent[i] = frame;
  }
  chain.flange = frame * model.tool;
  chain.tcp = given_way(chain.flange, springs.tool);
  return chain;
}

/// Force and moment about the base origin of all that acts beyond a cut.
struct Load {
  Vector3<double> force;
  Vector3<double> moment;

  void add_weight(double mass, const Vector3<double>& center, const Vector3<double>& gravity) {
    force += mass * gravity;
    moment += center.cross(mass * gravity);
  }

  /// As a wrench at a frame's origin, in that frame.
  Wrench<double> at(const Pose<double>& frame) const {
    Wrench<double> wrench;
    wrench << frame.rotation.transpose() * force,
        frame.rotation.transpose() * (moment - frame.position.cross(force));
    return wrench;
  }
};

Springs load_springs(const RobotModel<double, 6>& model, const BentChain& chain,
                     const Wrench<double>& wrench) {
  Springs springs;
  const Vector3<double> force = wrench.head<3>();
  Load load{force, wrench.tail<3>() + chain.tcp.position.cross(force)};
  load.add_weight(model.payload_mass,
                  chain.tcp.position + chain.tcp.rotation * model.payload_center, model.gravity);
  // The tool's spring forces are those at the TCP, where the wrench is given.
  if (!model.tool_compliance.isZero(0)) {
    springs.tool =
        model.tool_compliance.cwiseProduct(load.at({chain.flange.rotation, chain.tcp.position}));
  }
  for (std::size_t i = 6; i-- > 0;) {
    const Joint<double>& joint = model.joints[i];
    load.add_weight(joint.mass,
                    chain.bent[i].position + chain.bent[i].rotation * joint.center_of_mass,
                    model.gravity);
    if (!joint.link_compliance.isZero(0)) {
      springs.link[i] = joint.link_compliance.cwiseProduct(load.at(chain.stiff[i]));
    }
    const Pose<double>& frame = chain.stiff[i];
    const double torque =
        (frame.rotation * joint.axis).dot(load.moment - frame.position.cross(load.force));
    springs.windup[static_cast<Eigen::Index>(i)] =
        (joint.compliance + joint.cubic_compliance * torque * torque) * torque;
  }
  springs.base = model.base_compliance.cwiseProduct(load.at(Pose<double>{}));
  return springs;
}

}  // namespace

Equilibrium settle(const RobotModel<double, 6>& model, const JointVector<double, 6>& q_motor,
                   const Wrench<double>& wrench, double tolerance) {
  Springs springs;
  return settle_from(model, q_motor, wrench, tolerance, &springs);
}

Equilibrium settle_from(const RobotModel<double, 6>& model, const JointVector<double, 6>& q_motor,
                        const Wrench<double>& wrench, double tolerance, Springs* springs) {
  constexpr int kMaxRounds = 200;
  for (int round = 0; round < kMaxRounds; ++round) {
    const BentChain chain = bend(model, q_motor, *springs);
    const Springs next = load_springs(model, chain, wrench);
    double change = (next.windup - springs->windup).cwiseAbs().maxCoeff();
    change = std::fmax(change, (next.base - springs->base).cwiseAbs().maxCoeff());
    change = std::fmax(change, (next.tool - springs->tool).cwiseAbs().maxCoeff());
    for (std::size_t i = 0; i < 6; ++i) {
      change = std::fmax(change, (next.link[i] - springs->link[i]).cwiseAbs().maxCoeff());
    }
    *springs = next;
    if (change <= tolerance) {
      return {chain.tcp, q_motor + springs->windup};
    }
    if (!std::isfinite(change) || change > 10) {
      break;
    }
  }
  throw InputError("the robot does not come to rest under this load: its springs are too soft");
}

RobotModel<double, 6> with_scaled_compliance(RobotModel<double, 6> model, double factor) {
  for (Joint<double>& joint : model.joints) {
    joint.compliance *= factor;
    joint.cubic_compliance *= factor;
    joint.link_compliance *= factor;
  }
  model.base_compliance *= factor;
  model.tool_compliance *= factor;
  return model;
}

RobotModel<double, 6> without_joint_springs(RobotModel<double, 6> model) {
  for (Joint<double>& joint : model.joints) {
    joint.compliance = 0;
    joint.cubic_compliance = 0;
  }
  return model;
}

}  // namespace flexcomp::simulation
