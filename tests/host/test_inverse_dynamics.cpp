// Inverse dynamics against Orocos KDL, which reads the same URDF, and against Newton's law.
#include <kdl/chainidsolver_recursive_newton_euler.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <random>
#include <string>

#include "flexcomp/chain.hpp"
#include "simulation/inverse_dynamics.hpp"
#include "unity_main.hpp"

using flexcomp::Jacobian;
using flexcomp::JointVector;
using flexcomp::Kinematics;
using flexcomp::Vector3;
using flexcomp::model::load_robot;
using flexcomp::model::Robot;
using flexcomp::simulation::inverse_dynamics;
using Row = JointVector<double, 6>;

namespace {

Robot shipped(const std::string& name) {
  Robot robot = load_robot(std::string(FLEXCOMP_ROBOTS "/") + name + "/robot.yaml");
  robot.elastic.gravity = {0.3, -1.2, -9.7};
  robot.elastic.payload_mass = 0;
  return robot;
}

Row drawn(std::mt19937* random, double size) {
  std::uniform_real_distribution<double> uniform(-size, size);
  return Row::NullaryExpr([&] { return uniform(*random); });
}

KDL::JntArray joints(const Row& values) {
  KDL::JntArray array(6);
  array.data = values;
  return array;
}

KDL::Chain chain_of(const Robot& robot) {
  KDL::Tree tree;
  KDL::Chain chain;
  TEST_ASSERT_TRUE(kdl_parser::treeFromFile(robot.urdf.string(), tree));
  TEST_ASSERT_TRUE(tree.getChain(robot.base_link, robot.tool_link, chain));
  return chain;
}

void torques_are_those_of_kdl() {
  std::mt19937 random(1);
  for (const char* name : {"kr100", "kr270", "kr360", "kr500"}) {
    const Robot robot = shipped(name);
    const KDL::Chain chain = chain_of(robot);
    const Vector3<double>& gravity = robot.elastic.gravity;
    KDL::ChainIdSolver_RNE solver(chain, {gravity.x(), gravity.y(), gravity.z()});
    const KDL::Wrenches none(chain.getNrOfSegments(), KDL::Wrench::Zero());
    for (int i = 0; i < 50; ++i) {
      const Row q = drawn(&random, 3);
      const Row velocity = drawn(&random, 4);
      const Row acceleration = drawn(&random, 20);
      KDL::JntArray expected(6);
      TEST_ASSERT_EQUAL(
          0, solver.CartToJnt(joints(q), joints(velocity), joints(acceleration), none, expected));
      const Row actual = inverse_dynamics(robot, q, velocity, acceleration);
      TEST_ASSERT_DOUBLE_WITHIN(1e-12 * expected.data.norm(), 0, (actual - expected.data).norm());
    }
  }
}

/// A payload adds the force that Newton's law asks for at its centre, whose acceleration is taken
/// by differences of the forward kinematics.
void a_payload_is_moved_by_newtons_law() {
  constexpr double kMass = 140;
  constexpr double kStep = 1e-4;  // s
  Robot robot = shipped("kr270");
  const Vector3<double> centre(0.1, -0.05, 0.2);  // m, tool frame
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    const Row q = drawn(&random, 3);
    const Row velocity = drawn(&random, 2);
    const Row acceleration = drawn(&random, 5);
    const auto at = [&](double t) {
      const Row moved = q + velocity * t + acceleration * (t * t / 2);
      return flexcomp::forward_kinematics<double, 6>(six_axis_model(robot), moved);
    };
    const auto position = [&](double t) -> Vector3<double> {
      const Kinematics<double, 6> posture = at(t);
      return posture.tcp.position + posture.tcp.rotation * centre;
    };
    const Vector3<double> pull =
        (position(kStep) - 2 * position(0) + position(-kStep)) / (kStep * kStep);
    const Jacobian<double, 6> jacobian =
        flexcomp::geometric_jacobian<double, 6>(at(0), position(0));
    const Row expected =
        jacobian.topRows<3>().transpose() * (kMass * (pull - robot.elastic.gravity));
    robot.elastic.payload_mass = 0;
    const Row without = inverse_dynamics(robot, q, velocity, acceleration);
    robot.elastic.payload_mass = kMass;
    robot.elastic.payload_center = centre;
    const Row change = inverse_dynamics(robot, q, velocity, acceleration) - without;
    TEST_ASSERT_DOUBLE_WITHIN(1e-5 * expected.norm(), 0, (change - expected).norm());
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(torques_are_those_of_kdl);
  RUN_TEST(a_payload_is_moved_by_newtons_law);
  return UNITY_END();
}
