#include <complex>
#include <random>

#include "core/test_robots.hpp"
#include "flexcomp/compliance.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::kr270;
using flexcomp::test::kr270_with_everything;
using flexcomp::test::loop_angles;

namespace {

using Angles = JointVector<double, 6>;
using Model = RobotModel<double, 6>;

Wrench<double> milling_wrench() {
  Wrench<double> wrench;
  wrench << 440, 1370, 635, 0, 3, 10.5;
  return wrench;
}

/// In the plane of joints 2 and 3, with w = x + iz, a force F deflects the TCP by
/// u = Σ k_j Im(conj(a_j) F) i a_j over joints 2, 3 and 5, a_j from the joint's axis to the TCP.
void in_the_plane_of_the_arm_the_closed_form_holds() {
  using Complex = std::complex<double>;
  const Model model = kr270<double>();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-2, 2);
  std::uniform_real_distribution<double> force(-2000, 2000);
  for (int i = 0; i < 200; ++i) {
    Angles q = Angles::Zero();
    q[1] = angle(random);
    q[2] = angle(random);
    q[4] = angle(random);
    const auto kinematics = forward_kinematics(model, q);
    const Complex f(force(random), force(random));
    const auto point = [](const Vector3<double>& p) { return Complex(p.x(), p.z()); };
    Complex expected = 0;
    for (const std::size_t joint : {1U, 2U, 4U}) {
      const Complex arm = point(kinematics.tcp.position) - point(kinematics.links[joint].position);
      expected +=
          model.joints[joint].compliance * std::imag(std::conj(arm) * f) * Complex(0, 1) * arm;
    }
    Wrench<double> wrench = Wrench<double>::Zero();
    wrench[0] = f.real();
    wrench[2] = f.imag();
    const Twist<double> twist = tcp_compliance(model, kinematics) * wrench;
    TEST_ASSERT_TRUE(std::abs(Complex(twist[0], twist[2]) - expected) < 1e-12);
  }
}

void compliance_is_symmetric_and_never_stores_negative_energy() {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 100; ++i) {
    const auto kinematics = forward_kinematics<double, 6>(kr270_with_everything<double>(),
                                                          loop_angles<double>(3 * uniform(random)));
    const Compliance<double> c = tcp_compliance(kr270_with_everything<double>(), kinematics);
    TEST_ASSERT_TRUE((c - c.transpose()).cwiseAbs().maxCoeff() < 1e-20);
    Wrench<double> wrench;
    for (Eigen::Index row = 0; row < 6; ++row) {
      wrench[row] = 1000 * uniform(random);
    }
    TEST_ASSERT_TRUE(wrench.dot(c * wrench) > 0);
  }
}

/// Virtual work: the weights' torque on a joint is the slope of their potential energy, falling.
void weight_torque_is_the_slope_of_potential_energy() {
  const Model model = kr270_with_everything<double>();
  const auto potential = [&](const Angles& q) {
    const auto at = forward_kinematics(model, q);
    double energy = -model.payload_mass *
                    model.gravity.dot(at.tcp.position + at.tcp.rotation * model.payload_center);
    for (std::size_t i = 0; i < 6; ++i) {
      energy -= model.joints[i].mass *
                model.gravity.dot(at.links[i].position +
                                  at.links[i].rotation * model.joints[i].center_of_mass);
    }
    return energy;
  };
  const Angles q = loop_angles<double>(0.7);
  const Angles torque = weight_torque(model, forward_kinematics(model, q));
  for (Eigen::Index joint = 0; joint < 6; ++joint) {
    const Angles step = 1e-5 * Angles::Unit(joint);
    const double slope = (potential(q + step) - potential(q - step)) / 2e-5;
    TEST_ASSERT_DOUBLE_WITHIN(1e-5, -slope, torque[joint]);
  }
}

/// The moment of a force is position cross force, whatever the frame: a base spring turned by it
/// carries the TCP along a rigid lever.
void a_base_spring_turns_the_whole_robot() {
  Model model = kr270<double>();
  for (Joint<double>& joint : model.joints) {
    joint.compliance = 0;
  }
  model.base_compliance << 0, 0, 0, 0, 0, 1e-7;
  const auto kinematics = forward_kinematics<double, 6>(model, loop_angles<double>(1));
  const Vector3<double> tcp = kinematics.tcp.position;
  const Wrench<double> wrench = milling_wrench();
  const Vector3<double> force = wrench.head<3>();
  const double angle = 1e-7 * (tcp.cross(force).z() + wrench[5]);
  const Twist<double> twist = tcp_compliance(model, kinematics) * wrench;
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, -angle * tcp.y(), twist[0]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, angle * tcp.x(), twist[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-18, 0, twist[2]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, angle, twist[5]);
}

/// In the tool's own frame the tool springs are diagonal.
void tool_springs_give_along_the_tools_axes() {
  Model model = kr270_with_everything<double>();
  for (Joint<double>& joint : model.joints) {
    joint.compliance = 0;
    joint.link_compliance.setZero();
  }
  model.base_compliance.setZero();
  const auto kinematics = forward_kinematics<double, 6>(model, loop_angles<double>(2));
  const Matrix3<double> tool = kinematics.tcp.rotation;
  const Compliance<double> c = tcp_compliance(model, kinematics);
  const Matrix3<double> linear = tool.transpose() * c.topLeftCorner<3, 3>() * tool;
  const Matrix3<double> expected = model.tool_compliance.head<3>().asDiagonal();
  TEST_ASSERT_TRUE((linear - expected).cwiseAbs().maxCoeff() < 1e-20);
  TEST_ASSERT_TRUE((c.topRightCorner<3, 3>().isZero(1e-20)));
}

void a_cubic_spring_gives_as_its_formula_says() {
  Model model = kr270<double>();
  model.joints[1].cubic_compliance = -2e-15;
  Angles torque = Angles::Zero();
  torque[1] = 3000;
  const Angles windup = joint_windup(model, torque);
  TEST_ASSERT_DOUBLE_WITHIN(1e-18, 0.29e-6 * 3000 - 2e-15 * 2.7e10, windup[1]);
}

void without_weight_and_wrench_nothing_gives() {
  const Deflection<double, 6> none =
      deflection<double, 6>(kr270<double>(), loop_angles<double>(0), Wrench<double>::Zero());
  TEST_ASSERT_TRUE(none.tcp.isZero(0));
  TEST_ASSERT_TRUE(none.windup.isZero(0));
}

void deflection_is_compliance_times_wrench_for_linear_springs() {
  Model model = kr270_with_everything<double>();
  model.gravity.setZero();
  for (Joint<double>& joint : model.joints) {
    joint.cubic_compliance = 0;
  }
  const Angles q = loop_angles<double>(0.3);
  const Twist<double> expected =
      tcp_compliance(model, forward_kinematics(model, q)) * milling_wrench();
  const Twist<double> twist = deflection(model, q, milling_wrench()).tcp;
  TEST_ASSERT_TRUE((twist - expected).cwiseAbs().maxCoeff() < 1e-15);
}

void joint_motion_moves_the_tcp_as_asked() {
  const auto kinematics = forward_kinematics<double, 6>(kr270<double>(), loop_angles<double>(1.1));
  const auto jacobian = geometric_jacobian<double, 6>(kinematics);
  Twist<double> twist;
  twist << 1e-3, -2e-3, 5e-4, 1e-3, 2e-3, -1e-3;
  TEST_ASSERT_TRUE((jacobian * joint_motion<double, 6>(jacobian, twist) - twist).norm() < 1e-14);
}

/// With axes 4 and 6 in line one rotation cannot be had; the solution must not run away.
void joint_motion_stays_small_at_a_wrist_singularity() {
  Angles q = loop_angles<double>(1.1);
  for (const double bend : {0.0, 1e-6, 1e-4, 1e-2}) {
    q[4] = bend;
    const auto jacobian =
        geometric_jacobian<double, 6>(forward_kinematics<double, 6>(kr270<double>(), q));
    const Angles motion = joint_motion<double, 6>(jacobian, Twist<double>::Constant(1e-3));
    TEST_ASSERT_TRUE(motion.allFinite());
    TEST_ASSERT_TRUE(motion.norm() < 0.1);
  }
}

/// The correction of joint springs is the wind-up itself, at singular postures too.
void joint_springs_are_corrected_by_their_windup() {
  Angles q = loop_angles<double>(0.5);
  q[4] = 0;
  const Angles correction = setpoint_correction<double, 6>(kr270<double>(), q, milling_wrench());
  const Deflection<double, 6> bent = deflection<double, 6>(kr270<double>(), q, milling_wrench());
  TEST_ASSERT_TRUE((correction + bent.windup).isZero(0));
  const auto jacobian =
      geometric_jacobian<double, 6>(forward_kinematics<double, 6>(kr270<double>(), q));
  TEST_ASSERT_TRUE((jacobian * correction + bent.tcp).norm() < 1e-15);
}

void other_springs_are_corrected_to_first_order() {
  const Model model = kr270_with_everything<double>();
  const Angles q = loop_angles<double>(0.5);
  const Angles correction = setpoint_correction(model, q, milling_wrench());
  const auto jacobian = geometric_jacobian<double, 6>(forward_kinematics(model, q));
  const Twist<double> left = jacobian * correction + deflection(model, q, milling_wrench()).tcp;
  TEST_ASSERT_TRUE(left.norm() < 1e-14);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(in_the_plane_of_the_arm_the_closed_form_holds);
  RUN_TEST(compliance_is_symmetric_and_never_stores_negative_energy);
  RUN_TEST(weight_torque_is_the_slope_of_potential_energy);
  RUN_TEST(a_base_spring_turns_the_whole_robot);
  RUN_TEST(tool_springs_give_along_the_tools_axes);
  RUN_TEST(a_cubic_spring_gives_as_its_formula_says);
  RUN_TEST(without_weight_and_wrench_nothing_gives);
  RUN_TEST(deflection_is_compliance_times_wrench_for_linear_springs);
  RUN_TEST(joint_motion_moves_the_tcp_as_asked);
  RUN_TEST(joint_motion_stays_small_at_a_wrist_singularity);
  RUN_TEST(joint_springs_are_corrected_by_their_windup);
  RUN_TEST(other_springs_are_corrected_to_first_order);
  return UNITY_END();
}
