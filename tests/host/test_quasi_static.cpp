#include <cmath>
#include <random>

#include "core/test_robots.hpp"
#include "error.hpp"
#include "simulation/quasi_static.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::kr270;
using flexcomp::test::kr270_with_everything;
using flexcomp::test::loop_angles;

namespace {

using Angles = JointVector<double, 6>;

simulation::Equilibrium settle(const RobotModel<double, 6>& model, const Angles& q,
                               const Wrench<double>& wrench, double tolerance = 1e-13) {
  return simulation::settle(model::chain_of(model), q, wrench, tolerance);
}

Wrench<double> milling_wrench(double scale) {
  Wrench<double> wrench;
  wrench << 440, 1370, 635, 0, 3, 10.5;
  return scale * wrench;
}

void without_load_the_robot_stands_where_its_motors_are() {
  const Angles q = loop_angles<double>(1);
  const auto at = settle(kr270<double>(), q, Wrench<double>::Zero());
  const Pose<double> stiff = forward_kinematics<double, 6>(kr270<double>(), q).tcp;
  TEST_ASSERT_TRUE(pose_difference(stiff, at.tcp).isZero(1e-15));
  TEST_ASSERT_TRUE(at.q_link == q);
}

/// Halving a small load quarters what the first-order prediction misses.
void the_equilibrium_approaches_the_linear_prediction_quadratically() {
  auto model = kr270_with_everything<double>();
  model.gravity.setZero();
  const Angles q = loop_angles<double>(2);
  const Pose<double> stiff = forward_kinematics(model, q).tcp;
  const auto missed = [&](double scale) {
    const Twist<double> bent = pose_difference(stiff, settle(model, q, milling_wrench(scale)).tcp);
    return (bent - deflection(model, q, milling_wrench(scale)).tcp).norm();
  };
  const double ratio = missed(0.2) / missed(0.1);
  TEST_ASSERT_TRUE(ratio > 3.5 && ratio < 4.5);
}

/// A robot on joint springs alone, so that its energy is easily written down, pulled by a force.
struct Pulled {
  RobotModel<double, 6> model = kr270<double>();
  Angles q = loop_angles<double>(0.4);
  Wrench<double> wrench = Wrench<double>::Zero();

  Pulled() { wrench.head<3>() = milling_wrench(1).head<3>(); }

  double energy(const Angles& windup) const {
    double sum =
        -wrench.head<3>().dot(forward_kinematics<double, 6>(model, q + windup).tcp.position);
    for (std::size_t i = 0; i < 6; ++i) {
      sum += std::pow(windup[static_cast<Eigen::Index>(i)], 2) / (2 * model.joints[i].compliance);
    }
    return sum;
  }
};

template <typename Energy>
void assert_least(const Energy& energy, const Angles& windup) {
  for (Eigen::Index joint = 0; joint < 6; ++joint) {
    for (const double step : {-1e-5, 1e-5}) {
      TEST_ASSERT_TRUE(energy(windup + step * Angles::Unit(joint)) > energy(windup));
    }
  }
}

/// The state is a minimum of potential energy: springs and load.
void the_equilibrium_has_the_least_energy() {
  const Pulled robot;
  const Angles windup = settle(robot.model, robot.q, robot.wrench).q_link - robot.q;
  assert_least([&](const Angles& other) { return robot.energy(other); }, windup);
}

/// So it is with a spring from the base to a link beside the drive's own.
void the_equilibrium_with_a_balancer_has_the_least_energy() {
  constexpr Eigen::Index kJoint = 1;
  constexpr double kRate = 3e5;    // N·m/rad
  constexpr double kRelaxed = -1;  // rad
  const Pulled robot;
  const model::Chain chain = model::chain_of(robot.model);
  simulation::Springs springs(chain);
  const auto balance = [&](const model::JointValues& q_link) {
    model::JointValues torque = model::JointValues::Zero(6);
    torque[kJoint] = -kRate * (q_link[kJoint] - kRelaxed);
    return torque;
  };
  const Angles windup =
      simulation::settle_from(chain, robot.q, robot.wrench, 1e-13, &springs, balance).q_link -
      robot.q;
  assert_least(
      [&](const Angles& other) {
        return robot.energy(other) +
               kRate / 2 * std::pow(robot.q[kJoint] + other[kJoint] - kRelaxed, 2);
      },
      windup);
}

void corrected_joint_springs_leave_no_error() {
  auto model = kr270<double>();
  model.gravity = Vector3<double>(0, 0, -9.81);
  model.joints[1].mass = 200;
  model.joints[1].center_of_mass = Vector3<double>(0.6, 0, 0);
  model.joints[2].cubic_compliance = 1e-15;
  for (int i = 0; i < 20; ++i) {
    Angles q = loop_angles<double>(i);
    q[4] = i % 2 == 0 ? 0 : q[4];  // at a wrist singularity too
    const Pose<double> wanted = forward_kinematics(model, q).tcp;
    const Angles command = q + setpoint_correction(model, q, milling_wrench(1));
    const Twist<double> left =
        pose_difference(wanted, settle(model, command, milling_wrench(1)).tcp);
    TEST_ASSERT_TRUE(left.cwiseAbs().maxCoeff() < 1e-12);
  }
}

/// Base, link and tool springs are corrected by one Newton step; what is left is of second order.
void corrected_structure_springs_leave_their_stated_remainder() {
  const auto model = kr270_with_everything<double>();
  for (int i = 0; i < 20; ++i) {
    const Angles q = loop_angles<double>(i);
    const auto bent = deflection(model, q, milling_wrench(1));
    const auto jacobian = geometric_jacobian<double, 6>(forward_kinematics(model, q));
    const double structure = (bent.tcp - jacobian * bent.windup).norm();
    const double whole = bent.tcp.norm();
    const Pose<double> wanted = forward_kinematics(model, q).tcp;
    const Angles command = q + setpoint_correction(model, q, milling_wrench(1));
    const Twist<double> left =
        pose_difference(wanted, settle(model, command, milling_wrench(1)).tcp);
    TEST_ASSERT_TRUE(left.head<3>().norm() < 3 * structure * whole);
  }
}

void scaled_springs_bend_in_proportion() {
  auto model = kr270_with_everything<double>();
  model.gravity.setZero();
  const auto softer = simulation::with_scaled_compliance(model, 1.2);
  const Angles q = loop_angles<double>(0);
  const Twist<double> expected = 1.2 * deflection(model, q, milling_wrench(1)).tcp;
  TEST_ASSERT_TRUE((deflection(softer, q, milling_wrench(1)).tcp - expected).norm() < 1e-15);
}

/// Along a path and after a leap to another posture and load.
void the_equilibrium_is_the_same_wherever_it_is_sought_from() {
  constexpr double kTolerance = 1e-13;
  const auto model = kr270_with_everything<double>();
  const model::Chain chain = model::chain_of(model);
  simulation::Springs springs(chain);
  for (const double place : {0.0, 0.01, 0.02, 3.0}) {
    const Angles q = loop_angles<double>(place);
    const Wrench<double> wrench = milling_wrench(1 - place);
    const auto afresh = settle(model, q, wrench, kTolerance);
    const auto at = simulation::settle_from(chain, q, wrench, kTolerance, &springs);
    TEST_ASSERT_TRUE((at.q_link - q - springs.windup).isZero(1e-15));
    TEST_ASSERT_TRUE((at.q_link - afresh.q_link).isZero(10 * kTolerance));
    TEST_ASSERT_TRUE(pose_difference(afresh.tcp, at.tcp).isZero(10 * kTolerance));
  }
}

void springs_without_an_equilibrium_are_refused() {
  const auto soft = simulation::with_scaled_compliance(kr270<double>(), 1e5);
  bool refused = false;
  try {
    settle(soft, loop_angles<double>(0), milling_wrench(10));
  } catch (const InputError&) {
    refused = true;
  }
  TEST_ASSERT_TRUE(refused);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(without_load_the_robot_stands_where_its_motors_are);
  RUN_TEST(the_equilibrium_approaches_the_linear_prediction_quadratically);
  RUN_TEST(the_equilibrium_has_the_least_energy);
  RUN_TEST(the_equilibrium_with_a_balancer_has_the_least_energy);
  RUN_TEST(corrected_joint_springs_leave_no_error);
  RUN_TEST(corrected_structure_springs_leave_their_stated_remainder);
  RUN_TEST(scaled_springs_bend_in_proportion);
  RUN_TEST(the_equilibrium_is_the_same_wherever_it_is_sought_from);
  RUN_TEST(springs_without_an_equilibrium_are_refused);
  return UNITY_END();
}
