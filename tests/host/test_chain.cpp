// Chains of any joints: like the core's where they are six that turn, like Orocos KDL's elsewhere.
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <random>

#include "core/test_robots.hpp"
#include "flexcomp/compliance.hpp"
#include "model/kdl.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "simulation/quasi_static.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using model::Chain;
using model::ChainJoint;
using model::JointType;
using model::JointValues;
using model::to_kdl;
using simulation::settle;

namespace {

constexpr int kPostures = 20;

using Random = std::mt19937;

double drawn(Random* random, double size) {
  return std::uniform_real_distribution<double>(-size, size)(*random);
}

JointValues drawn(Random* random, Eigen::Index joints, double size) {
  return JointValues::NullaryExpr(joints, [&] { return drawn(random, size); });
}

Vector3<double> drawn_vector(Random* random, double size) {
  return Vector3<double>::NullaryExpr([&] { return drawn(random, size); });
}

Wrench<double> drawn_wrench(Random* random) {
  Wrench<double> wrench;
  wrench << drawn_vector(random, 1000), drawn_vector(random, 100);
  return wrench;
}

Pose<double> drawn_pose(Random* random) {
  Twist<double> twist;
  twist << drawn_vector(random, 0.7), drawn_vector(random, 2);
  return displaced(Pose<double>{}, twist);
}

ChainJoint drawn_joint(Random* random) {
  ChainJoint joint;
  joint.type = (*random)() % 3 == 0 ? JointType::prismatic : JointType::revolute;
  joint.origin = drawn_pose(random);
  joint.axis = drawn_vector(random, 1).normalized();
  joint.lower = -3;
  joint.upper = 3;
  joint.compliance = 1e-7 * (2 + drawn(random, 1));
  joint.mass = 20 + drawn(random, 10);
  joint.center_of_mass = drawn_vector(random, 0.3);
  return joint;
}

/// Joints that turn and slide, with springs and weights.
model::Robot drawn_robot(Random* random, std::size_t joints) {
  model::Robot robot;
  robot.set_joints(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    robot.elastic.joints[i] = drawn_joint(random);
    robot.link_inertia[i] = Vector3<double>(2, 3, 4).asDiagonal();
  }
  robot.elastic.tool = drawn_pose(random);
  robot.elastic.gravity = {0.3, -1.2, -9.7};
  return robot;
}

/// The same machine as Orocos KDL has it.
class Reference {
 public:
  explicit Reference(const model::Robot& robot)
      : joints_(static_cast<unsigned>(robot.joints())), gravity_(to_kdl(robot.elastic.gravity)) {
    for (std::size_t i = 0; i < robot.elastic.joints.size(); ++i) {
      const ChainJoint& joint = robot.elastic.joints[i];
      const Matrix3<double>& about_center = robot.link_inertia[i];
      chain_.addSegment(fixed(joint.origin));
      const KDL::RigidBodyInertia body(
          joint.mass, to_kdl(joint.center_of_mass),
          KDL::RotationalInertia(about_center(0, 0), about_center(1, 1), about_center(2, 2)));
      const auto type = joint.slides() ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
      const KDL::Joint moving(KDL::Vector::Zero(), to_kdl(joint.axis), type);
      chain_.addSegment(KDL::Segment(moving, KDL::Frame::Identity(), body));
    }
    chain_.addSegment(fixed(robot.elastic.tool));
  }

  KDL::Frame tcp(const JointValues& q) const {
    KDL::Frame frame;
    KDL::ChainFkSolverPos_recursive solver(chain_);
    TEST_ASSERT_EQUAL(0, solver.JntToCart(array(q), frame));
    return frame;
  }

  Eigen::MatrixXd jacobian(const JointValues& q) const {
    KDL::Jacobian result(joints_);
    KDL::ChainJntToJacSolver solver(chain_);
    TEST_ASSERT_EQUAL(0, solver.JntToJac(array(q), result));
    return result.data;
  }

  Eigen::VectorXd torque(const JointValues& q, const JointValues& velocity,
                         const JointValues& acceleration) const {
    KDL::JntArray result(joints_);
    KDL::ChainIdSolver_RNE solver(chain_, gravity_);
    const KDL::Wrenches none(chain_.getNrOfSegments(), KDL::Wrench::Zero());
    TEST_ASSERT_EQUAL(
        0, solver.CartToJnt(array(q), array(velocity), array(acceleration), none, result));
    return result.data;
  }

 private:
  static KDL::Segment fixed(const Pose<double>& pose) {
    return KDL::Segment(KDL::Joint(KDL::Joint::Fixed), to_kdl(pose));
  }

  static KDL::JntArray array(const JointValues& q) {
    KDL::JntArray values(static_cast<unsigned>(q.size()));
    values.data = q;
    return values;
  }

  KDL::Chain chain_;
  unsigned joints_;
  KDL::Vector gravity_;
};

/// Calls `check(robot, reference, random)` for robots of every number of joints.
template <typename Check>
void for_every_size(Check check) {
  Random random(1);
  for (std::size_t joints = 1; joints <= static_cast<std::size_t>(model::kMostJoints); ++joints) {
    for (int i = 0; i < kPostures; ++i) {
      const model::Robot robot = drawn_robot(&random, joints);
      check(robot, Reference(robot), &random);
    }
  }
}

void pose_and_jacobian_are_those_of_kdl() {
  for_every_size([](const model::Robot& robot, const Reference& reference, Random* random) {
    const JointValues q = drawn(random, robot.joints(), 3);
    const auto actual = forward_kinematics(robot.elastic, q);
    const KDL::Frame expected = reference.tcp(q);
    TEST_ASSERT_TRUE(KDL::Equal(expected, to_kdl(actual.tcp), 1e-12));
    const Eigen::MatrixXd jacobian = geometric_jacobian(robot.elastic, actual);
    TEST_ASSERT_TRUE((jacobian - reference.jacobian(q)).isZero(1e-12));
  });
}

void torques_are_those_of_kdl() {
  for_every_size([](const model::Robot& robot, const Reference& reference, Random* random) {
    const JointValues q = drawn(random, robot.joints(), 3);
    const JointValues velocity = drawn(random, robot.joints(), 4);
    const JointValues acceleration = drawn(random, robot.joints(), 20);
    const Eigen::VectorXd expected = reference.torque(q, velocity, acceleration);
    const Eigen::VectorXd actual = simulation::inverse_dynamics(robot, q, velocity, acceleration);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12 * expected.norm(), 0, (actual - expected).norm());
  });
}

/// Every spring gives by its compliance times what KDL says that it bears where the links stand.
void at_rest_springs_bear_what_kdl_says() {
  for_every_size([](const model::Robot& robot, const Reference& reference, Random* random) {
    const JointValues q = drawn(random, robot.joints(), 3);
    const Wrench<double> wrench = drawn_wrench(random);
    const simulation::Equilibrium at = settle(robot.elastic, q, wrench);
    const JointValues none = JointValues::Zero(robot.joints());
    const Eigen::VectorXd load = reference.jacobian(at.q_link).transpose() * wrench -
                                 reference.torque(at.q_link, none, none);
    for (Eigen::Index i = 0; i < load.size(); ++i) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, robot.elastic.joint(i).compliance * load[i],
                                at.q_link[i] - q[i]);
    }
    TEST_ASSERT_TRUE(KDL::Equal(reference.tcp(at.q_link), to_kdl(at.tcp), 1e-11));
  });
}

/// Base, link and tool springs, which KDL does not have, by the motion under small wrenches.
void compliance_is_the_slope_of_the_equilibrium() {
  Random random(2);
  for (const std::size_t joints : {1U, 4U, 12U}) {
    Chain chain = drawn_robot(&random, joints).elastic;
    chain.gravity.setZero();
    chain.base_compliance << 1e-9, 2e-9, 3e-9, 4e-9, 5e-9, 6e-9;
    chain.tool_compliance << 6e-9, 5e-9, 4e-9, 3e-9, 2e-9, 1e-9;
    chain.joints.back().link_compliance << 1e-9, 3e-9, 2e-9, 5e-9, 4e-9, 6e-9;
    const JointValues q = drawn(&random, chain.size(), 3);
    const auto at = forward_kinematics(chain, q);
    const Wrench<double> wrench = 1e-3 * drawn_wrench(&random);
    const Twist<double> moved =
        pose_difference(settle(chain, q, -wrench).tcp, settle(chain, q, wrench).tcp) / 2;
    const Twist<double> expected = tcp_compliance(chain, at) * wrench;
    TEST_ASSERT_DOUBLE_WITHIN(1e-4 * expected.norm(), 0, (moved - expected).norm());
  }
}

void six_joints_that_turn_are_as_in_the_core() {
  constexpr double kRounding = 1e-15;
  Random random(3);
  for (int i = 0; i < kPostures; ++i) {
    RobotModel<double, 6> core = test::kr270_with_everything<double>();
    for (Joint<double>& joint : core.joints) {
      joint = drawn_joint(&random);
      joint.cubic_compliance = 1e-14 * drawn(&random, 1);
      joint.link_compliance << 1e-9, 2e-9, 3e-9, 4e-9, 5e-9, 6e-9;
    }
    const Chain chain = model::chain_of(core);
    const JointVector<double, 6> q = drawn(&random, 6, 3);
    const auto expected = flexcomp::forward_kinematics(core, q);
    const auto actual = model::forward_kinematics(chain, q);
    TEST_ASSERT_TRUE((expected.tcp.position - actual.tcp.position).isZero(10 * kRounding));
    const JointVector<double, 6> weight = weight_torque(core, expected);
    TEST_ASSERT_TRUE((weight - model::weight_torque(chain, actual)).isZero(1e-13 * weight.norm()));
    TEST_ASSERT_TRUE((joint_windup(core, weight) - model::joint_windup(chain, weight))
                         .isZero(1e-13 * weight.norm()));
    const Compliance<double> compliance = tcp_compliance(core, expected);
    TEST_ASSERT_TRUE((compliance - model::tcp_compliance(chain, actual))
                         .isZero(1e-14 * compliance.cwiseAbs().maxCoeff()));
  }
}

/// With joint springs alone the core's deflection is exact at the angles that the links have.
void the_equilibrium_is_that_of_the_core() {
  Random random(4);
  RobotModel<double, 6> core = test::kr270_with_everything<double>();
  core.base_compliance.setZero();
  core.tool_compliance.setZero();
  for (Joint<double>& joint : core.joints) {
    joint.link_compliance.setZero();
  }
  for (int i = 0; i < kPostures; ++i) {
    const JointVector<double, 6> q = drawn(&random, 6, 1);
    const Wrench<double> wrench = drawn_wrench(&random);
    const JointVector<double, 6> link = settle(model::chain_of(core), q, wrench).q_link;
    TEST_ASSERT_TRUE((deflection(core, link, wrench).windup - (link - q)).isZero(1e-12));
  }
}

/// A carriage of 20 kg that goes up and down on a spring that gives by 1 µm/N and, the more it
/// bears, by 1e-13 m/N³ times its cube: 196.2 N of weight and 300 N on the tool.
void a_slide_rests_where_weight_and_force_press_its_spring() {
  Chain chain;
  ChainJoint slide;
  slide.type = JointType::prismatic;
  slide.lower = -1;
  slide.upper = 1;
  slide.compliance = 1e-6;
  slide.cubic_compliance = 1e-13;
  slide.mass = 20;
  chain.joints.push_back(slide);
  chain.tool.position = {0.5, 0, 0.1};
  chain.gravity = {0, 0, -9.81};
  Wrench<double> wrench;
  wrench << 40, -70, -300, 5, 6, 7;  // of which only what acts along the slide counts
  const auto at = settle(chain, JointValues::Constant(1, 0.25), wrench);
  const double given = -(496.2e-6 + 1e-13 * 496.2 * 496.2 * 496.2);
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.25 + given, at.q_link[0]);
  TEST_ASSERT_TRUE((at.tcp.position - Vector3<double>(0.5, 0, 0.35 + given)).isZero(1e-15));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(pose_and_jacobian_are_those_of_kdl);
  RUN_TEST(torques_are_those_of_kdl);
  RUN_TEST(at_rest_springs_bear_what_kdl_says);
  RUN_TEST(compliance_is_the_slope_of_the_equilibrium);
  RUN_TEST(six_joints_that_turn_are_as_in_the_core);
  RUN_TEST(the_equilibrium_is_that_of_the_core);
  RUN_TEST(a_slide_rests_where_weight_and_force_press_its_spring);
  return UNITY_END();
}
