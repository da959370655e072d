#include "simulation/flexible_joint_plant.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <kdl/chaindynparam.hpp>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include "model/kdl.hpp"

namespace flexcomp::simulation {
namespace {

constexpr double kFrictionSpeed = 0.01;  // rad/s

KDL::RigidBodyInertia body(double mass, const Vector3<double>& center,
                           const Matrix3<double>& inertia) {
  return KDL::RigidBodyInertia(mass, model::to_kdl(center),
                               KDL::RotationalInertia(inertia(0, 0), inertia(1, 1), inertia(2, 2),
                                                      inertia(0, 1), inertia(0, 2), inertia(1, 2)));
}

/// A segment a link: KDL counts a segment from its joint to the next one, and wants its inertia
/// there.
template <int Joints>
KDL::Chain chain_of(const FlexibleArm<Joints>& arm) {
  constexpr auto kJoints = static_cast<std::size_t>(Joints);
  KDL::Chain chain;
  chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed),
                                model::to_kdl(arm.model.joints.front().origin),
                                KDL::RigidBodyInertia::Zero()));
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Joint<double>& joint = arm.model.joints[i];
    const bool last = i + 1 == kJoints;
    const KDL::Frame end = model::to_kdl(last ? arm.model.tool : arm.model.joints[i + 1].origin);
    KDL::RigidBodyInertia inertia =
        end.Inverse() * body(joint.mass, joint.center_of_mass, arm.inertia[i]);
    if (last) {
      inertia =
          inertia + body(arm.model.payload_mass, arm.model.payload_center, Matrix3<double>::Zero());
    }
    chain.addSegment(KDL::Segment(
        KDL::Joint(KDL::Vector::Zero(), model::to_kdl(joint.axis), KDL::Joint::RotAxis), end,
        inertia));
  }
  return chain;
}

template <typename Angles>
KDL::JntArray joints(const Angles& values) {
  KDL::JntArray array(static_cast<unsigned>(values.size()));
  array.data = values;
  return array;
}

}  // namespace

/// KDL's solvers and their memory.
template <int Joints>
struct FlexibleJointPlant<Joints>::RigidBody {
  using Square = Eigen::Matrix<double, Joints, Joints>;

  explicit RigidBody(const FlexibleArm<Joints>& arm)
      : chain(chain_of(arm)),
        gravity(model::to_kdl(arm.model.gravity)),
        solver(chain, gravity),
        inverse(chain, gravity),
        nothing(chain.getNrOfSegments(), KDL::Wrench::Zero()),
        matrix(Joints),
        array(Joints) {}

  Square mass(const Angles& q) {
    solver.JntToMass(joints(q), matrix);
    return matrix.data;
  }

  Angles weight(const Angles& q) {
    solver.JntToGravity(joints(q), array);
    return array.data;
  }

  /// Weight, centrifugal and Coriolis torques.
  Angles bias(const Angles& q, const Angles& velocity) {
    inverse.CartToJnt(joints(q), joints(velocity), KDL::JntArray(Joints), nothing, array);
    return array.data;
  }

  double potential(const Angles& q) {
    KDL::ChainFkSolverPos_recursive position(chain);
    double sum = 0;
    for (unsigned i = 0; i < chain.getNrOfSegments(); ++i) {
      KDL::Frame frame;
      position.JntToCart(joints(q), frame, static_cast<int>(i) + 1);
      const KDL::RigidBodyInertia& inertia = chain.getSegment(i).getInertia();
      sum -= inertia.getMass() * KDL::dot(gravity, frame * inertia.getCOG());
    }
    return sum;
  }

  KDL::Chain chain;
  KDL::Vector gravity;
  KDL::ChainDynParam solver;
  KDL::ChainIdSolver_RNE inverse;
  KDL::Wrenches nothing;
  KDL::JntSpaceInertiaMatrix matrix;
  KDL::JntArray array;
};

template <int Joints>
FlexibleJointPlant<Joints>::FlexibleJointPlant(const FlexibleArm<Joints>& arm) {
  change_arm(arm);
}

template <int Joints>
FlexibleJointPlant<Joints>::~FlexibleJointPlant() = default;

template <int Joints>
void FlexibleJointPlant<Joints>::change_arm(const FlexibleArm<Joints>& arm) {
  arm_ = arm;
  stiffness_ = arm.stiffness();
  rigid_ = std::make_unique<RigidBody>(arm);
}

template <int Joints>
void FlexibleJointPlant<Joints>::rest(const Angles& link, const Angles& external) {
  state_ = State();
  state_.link = link;
  state_.motor = link + (rigid_->weight(link) - external).cwiseQuotient(stiffness_);
}

template <int Joints>
auto FlexibleJointPlant<Joints>::slope(const State& at, const Angles& torque,
                                       const Angles& external) const -> State {
  const Angles elastic = stiffness_.cwiseProduct(at.motor - at.link);
  const Angles bias = rigid_->bias(at.link, at.link_velocity);
  const Angles friction =
      arm_.viscous.cwiseProduct(at.motor_velocity) +
      arm_.coulomb.cwiseProduct((at.motor_velocity / kFrictionSpeed).array().tanh().matrix());
  State slope;
  slope.link = at.link_velocity;
  slope.link_velocity = rigid_->mass(at.link).llt().solve(elastic + external - bias);
  slope.motor = at.motor_velocity;
  slope.motor_velocity = (torque - friction - elastic).cwiseQuotient(arm_.rotor_inertia);
  return slope;
}

template <int Joints>
void FlexibleJointPlant<Joints>::advance(const Angles& torque, const Angles& external, double time,
                                         int steps) {
  const double step = time / steps;
  const auto moved = [this](const State& slope, double by) {
    return State{state_.link + by * slope.link, state_.link_velocity + by * slope.link_velocity,
                 state_.motor + by * slope.motor,
                 state_.motor_velocity + by * slope.motor_velocity};
  };
  for (int i = 0; i < steps; ++i) {
    const State a = slope(state_, torque, external);
    const State b = slope(moved(a, step / 2), torque, external);
    const State c = slope(moved(b, step / 2), torque, external);
    const State d = slope(moved(c, step), torque, external);
    const State mean = {
        a.link + 2 * b.link + 2 * c.link + d.link,
        a.link_velocity + 2 * b.link_velocity + 2 * c.link_velocity + d.link_velocity,
        a.motor + 2 * b.motor + 2 * c.motor + d.motor,
        a.motor_velocity + 2 * b.motor_velocity + 2 * c.motor_velocity + d.motor_velocity};
    state_ = moved(mean, step / 6);
  }
}

template <int Joints>
double FlexibleJointPlant<Joints>::energy() const {
  const Angles windup = state_.motor - state_.link;
  return 0.5 * state_.link_velocity.dot(rigid_->mass(state_.link) * state_.link_velocity) +
         0.5 * state_.motor_velocity.cwiseAbs2().dot(arm_.rotor_inertia) +
         0.5 * windup.cwiseAbs2().dot(stiffness_) + rigid_->potential(state_.link);
}

template class FlexibleJointPlant<1>;
template class FlexibleJointPlant<2>;
template class FlexibleJointPlant<6>;

}  // namespace flexcomp::simulation
