#include "simulation/inverse_dynamics.hpp"

#include <kdl/chain.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>

#include "model/kdl.hpp"

namespace flexcomp::simulation {
namespace {

using model::to_kdl;

KDL::RigidBodyInertia body(double mass, const Vector3<double>& center,
                           const Matrix3<double>& about_center) {
  const KDL::RotationalInertia inertia(about_center(0, 0), about_center(1, 1), about_center(2, 2),
                                       about_center(0, 1), about_center(0, 2), about_center(1, 2));
  return KDL::RigidBodyInertia(mass, to_kdl(center), inertia);
}

/// KDL turns about an axis of the frame before the segment; a fixed segment carries the origin.
KDL::Chain rigid_chain(const model::Robot& robot) {
  using Axis = KDL::Joint;
  KDL::Chain chain;
  for (std::size_t i = 0; i < 6; ++i) {
    const Joint<double>& joint = robot.elastic.joints[i];
    chain.addSegment(KDL::Segment(Axis(Axis::None), to_kdl(joint.origin)));
    chain.addSegment(KDL::Segment(Axis(KDL::Vector::Zero(), to_kdl(joint.axis), Axis::RotAxis),
                                  KDL::Frame::Identity(),
                                  body(joint.mass, joint.center_of_mass, robot.link_inertia[i])));
  }
  chain.addSegment(KDL::Segment(
      Axis(Axis::None), to_kdl(robot.elastic.tool),
      body(robot.elastic.payload_mass, robot.elastic.payload_center, Matrix3<double>::Zero())));
  return chain;
}

KDL::JntArray joints(const JointVector<double, 6>& values) {
  KDL::JntArray array(6);
  array.data = values;
  return array;
}

}  // namespace

struct InverseDynamics::Solver {
  explicit Solver(const model::Robot& robot)
      : chain(rigid_chain(robot)),
        newton_euler(chain, to_kdl(robot.elastic.gravity)),
        none(chain.getNrOfSegments(), KDL::Wrench::Zero()) {}

  KDL::Chain chain;
  KDL::ChainIdSolver_RNE newton_euler;
  KDL::Wrenches none;
};

InverseDynamics::InverseDynamics(const model::Robot& robot)
    : solver_(std::make_unique<Solver>(robot)) {}

InverseDynamics::~InverseDynamics() = default;

JointVector<double, 6> InverseDynamics::torque(const JointVector<double, 6>& q,
                                               const JointVector<double, 6>& velocity,
                                               const JointVector<double, 6>& acceleration) const {
  KDL::JntArray result(6);
  solver_->newton_euler.CartToJnt(joints(q), joints(velocity), joints(acceleration), solver_->none,
                                  result);
  return result.data;
}

}  // namespace flexcomp::simulation
