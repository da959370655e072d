#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/rigidbodyinertia.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <limits>
#include <stdexcept>

#include "error.hpp"
#include "host/arm_robot.hpp"
#include "model/chain_kinematics.hpp"
#include "model/robot.hpp"
#include "unity_main.hpp"

using flexcomp::InputError;
using flexcomp::JointVector;
using flexcomp::Matrix3;
using flexcomp::Vector3;
using flexcomp::model::load_robot;
using flexcomp::model::Robot;
using flexcomp::model::write_robot;
using flexcomp::test::content_of;
using flexcomp::test::put_arm;
using flexcomp::test::ScratchFolder;
namespace fs = std::filesystem;

namespace {

/// The arm with a value of its own for everything that a YAML file can say.
Robot full_robot(const ScratchFolder& folder) {
  put_arm(folder);
  Robot robot = load_robot(folder / "robot.yaml");
  robot.name = "Name: with \"marks\" #1 ä";
  for (std::size_t i = 0; i < 6; ++i) {
    const double n = static_cast<double>(i) + 1;
    flexcomp::model::ChainJoint& joint = robot.elastic.joints[i];
    joint.compliance = n / 3 * 1e-6;
    joint.cubic_compliance = -n * 1e-17;
    joint.link_compliance << 1e-3 * n, 0, 1e-3 / n, 1e-9, 0.02, 0.03;
    robot.dynamics[i].viscous = n * 10;
    robot.dynamics[i].coulomb = n * 0.1;
    robot.dynamics[i].rotor_inertia = n * 7;
    robot.dynamics[i].backlash = n * 1e-5;
  }
  robot.elastic.gravity << 0.1, -0.2, -9.81;
  robot.elastic.base_compliance << 1e-9, 2e-9, 3e-9, 4e-9, 5e-9, 6e-9;
  robot.elastic.tool_compliance << 0, 0, 0, 0, 0, 1e-300;
  robot.elastic.payload_mass = 123.456;
  robot.elastic.payload_center << 0.1, 0.2, 1.0 / 3;
  robot.transmission(5, 4) = 1.0 / 3;
  robot.reference_temperature = 20 + 1.0 / 3;
  return robot;
}

void assert_same_yaml(const Robot& expected, const Robot& actual) {
  TEST_ASSERT_EQUAL_STRING(expected.name.c_str(), actual.name.c_str());
  TEST_ASSERT_EQUAL_STRING(expected.base_link.c_str(), actual.base_link.c_str());
  TEST_ASSERT_EQUAL_STRING(expected.tool_link.c_str(), actual.tool_link.c_str());
  TEST_ASSERT_TRUE(expected.elastic.gravity == actual.elastic.gravity);
  TEST_ASSERT_TRUE(expected.elastic.base_compliance == actual.elastic.base_compliance);
  TEST_ASSERT_TRUE(expected.elastic.tool_compliance == actual.elastic.tool_compliance);
  TEST_ASSERT_TRUE(expected.elastic.payload_mass == actual.elastic.payload_mass);
  TEST_ASSERT_TRUE(expected.elastic.payload_center == actual.elastic.payload_center);
  TEST_ASSERT_TRUE(expected.transmission == actual.transmission);
  TEST_ASSERT_TRUE(expected.reference_temperature == actual.reference_temperature);
  for (std::size_t i = 0; i < 6; ++i) {
    const flexcomp::model::ChainJoint& spring = expected.elastic.joints[i];
    const flexcomp::model::ChainJoint& read = actual.elastic.joints[i];
    TEST_ASSERT_TRUE(spring.compliance == read.compliance);
    TEST_ASSERT_TRUE(spring.cubic_compliance == read.cubic_compliance);
    TEST_ASSERT_TRUE(spring.link_compliance == read.link_compliance);
    TEST_ASSERT_TRUE(expected.dynamics[i].viscous == actual.dynamics[i].viscous);
    TEST_ASSERT_TRUE(expected.dynamics[i].coulomb == actual.dynamics[i].coulomb);
    TEST_ASSERT_TRUE(expected.dynamics[i].rotor_inertia == actual.dynamics[i].rotor_inertia);
    TEST_ASSERT_TRUE(expected.dynamics[i].backlash == actual.dynamics[i].backlash);
  }
}

void keys_that_are_left_out_are_zero() {
  const ScratchFolder folder;
  put_arm(folder, {"payload: {mass: 7}\n", ""});
  const Robot robot = load_robot(folder / "robot.yaml");
  TEST_ASSERT_FALSE(has_structure_springs(robot.elastic));
  TEST_ASSERT_TRUE(robot.elastic.payload_mass == 0);
  TEST_ASSERT_TRUE(robot.elastic.payload_center.isZero(0));
  TEST_ASSERT_TRUE(robot.transmission.isIdentity(0));
  TEST_ASSERT_TRUE(robot.elastic.joints[1].cubic_compliance == 0);
  TEST_ASSERT_TRUE(robot.dynamics[0].backlash == 0);
  TEST_ASSERT_TRUE(robot.dynamics[1].backlash == 1e-4);
  TEST_ASSERT_TRUE(robot.dynamics[1].viscous == 0);
}

void limits_and_axes_come_from_the_urdf() {
  const ScratchFolder folder;
  put_arm(folder, {}, {"'0.6 0 0.8'", "'0.7071 0 -0.7071'"});
  const Robot robot = load_robot(folder / "robot.yaml");
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 1, robot.elastic.joints[0].axis.norm());
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, -robot.elastic.joints[0].axis.x(),
                            robot.elastic.joints[0].axis.z());
  TEST_ASSERT_TRUE(robot.elastic.joints[5].lower == -1 && robot.elastic.joints[5].upper == 1);
  TEST_ASSERT_TRUE(robot.dynamics[5].effort == 10 && robot.dynamics[5].velocity == 2);
  TEST_ASSERT_EQUAL_STRING("j6", robot.joint_names[5].c_str());
}

void odd_axes_and_fixed_joints_move_the_tool_as_in_kdl() {
  const ScratchFolder folder;
  put_arm(folder);
  const Robot robot = load_robot(folder / "robot.yaml");
  KDL::Tree tree;
  KDL::Chain chain;
  TEST_ASSERT_TRUE(kdl_parser::treeFromFile(robot.urdf.string(), tree));
  TEST_ASSERT_TRUE(tree.getChain("base", "tool", chain));
  KDL::JntArray q(6);
  q.data << 0.3, -0.5, 0.7, -0.9, 0.2, 0.4;
  KDL::Frame frame;
  KDL::ChainFkSolverPos_recursive(chain).JntToCart(q, frame);
  const auto ours = forward_kinematics(robot.elastic, q.data);
  for (int row = 0; row < 3; ++row) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, frame.p(row), ours.tcp.position[row]);
    for (int column = 0; column < 3; ++column) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-14, frame.M(row, column), ours.tcp.rotation(row, column));
    }
  }
}

void assert_same_body(KDL::RigidBodyInertia expected, const Robot& robot, std::size_t joint) {
  const KDL::Vector center = expected.getCOG();
  const KDL::RotationalInertia at_center = expected.RefPoint(center).getRotationalInertia();
  TEST_ASSERT_DOUBLE_WITHIN(1e-13, expected.getMass(), robot.elastic.joints[joint].mass);
  for (int row = 0; row < 3; ++row) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-14, center(row), robot.elastic.joints[joint].center_of_mass[row]);
    for (int column = 0; column < 3; ++column) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-13, at_center.data[3 * row + column],
                                robot.link_inertia[joint](row, column));
    }
  }
}

void what_hangs_on_a_link_is_part_of_its_body() {
  const ScratchFolder folder;
  put_arm(folder);
  const Robot robot = load_robot(folder / "robot.yaml");
  KDL::Tree tree;
  TEST_ASSERT_TRUE(kdl_parser::treeFromFile(robot.urdf.string(), tree));
  const auto segment = [&](const char* name) { return tree.getSegment(name)->second.segment; };
  const auto hung = [&](const char* name) {
    return segment(name).getFrameToTip() * segment(name).getInertia();
  };
  assert_same_body(segment("l2").getInertia(), robot, 1);
  assert_same_body(segment("l3").getInertia() + hung("bracket"), robot, 2);
  assert_same_body(segment("l6").getInertia() + hung("finger"), robot, 5);
}

constexpr const char* kTool =
    "tool: {xyz: [0.02, -0.05, 0.12], rpy: [0.3, -0.2, 1.1], mass: 9, com: [0.01, 0.02, 0.05],\n"
    "  inertia: [0.3, 0.01, -0.02, 0.2, 0.03, 0.25]}\n";

/// The same tool as links of the URDF.
constexpr const char* kToolLinks =
    "<joint name='screwed' type='fixed'><parent link='tool'/><child link='spindle'/></joint>\n"
    "<link name='spindle'><inertial><origin xyz='0.01 0.02 0.05'/><mass value='9'/>\n"
    "<inertia ixx='0.3' ixy='0.01' ixz='-0.02' iyy='0.2' iyz='0.03' "
    "izz='0.25'/></inertial></link>\n"
    "<joint name='clamped' type='fixed'><parent link='spindle'/><child link='tip'/>\n"
    "<origin xyz='0.02 -0.05 0.12' rpy='0.3 -0.2 1.1'/></joint>\n<link name='tip'/>\n</robot>";

void a_tool_in_the_yaml_is_one_in_the_urdf() {
  const ScratchFolder folder;
  put_arm(folder, {"tool_link: tool", "tool_link: tip"}, {"</robot>", kToolLinks});
  const Robot expected = load_robot(folder / "robot.yaml");
  put_arm(folder, {"payload:", std::string(kTool) + "payload:"});
  const Robot robot = load_robot(folder / "robot.yaml");
  TEST_ASSERT_TRUE(robot.elastic.tool.position.isApprox(expected.elastic.tool.position, 1e-14));
  TEST_ASSERT_TRUE(robot.elastic.tool.rotation.isApprox(expected.elastic.tool.rotation, 1e-14));
  const auto& last = robot.elastic.joints.back();
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected.elastic.joints.back().mass, last.mass);
  TEST_ASSERT_TRUE(
      last.center_of_mass.isApprox(expected.elastic.joints.back().center_of_mass, 1e-12));
  TEST_ASSERT_TRUE(robot.link_inertia.back().isApprox(expected.link_inertia.back(), 1e-12));
}

void a_tool_is_written_as_it_was_read_and_gives_way_to_another() {
  const ScratchFolder folder;
  put_arm(folder, {"payload:", std::string(kTool) + "payload:"});
  const Robot robot = load_robot(folder / "robot.yaml");
  write_robot(folder / "again.yaml", robot);
  const Robot again = load_robot(folder / "again.yaml");
  TEST_ASSERT_TRUE(again.elastic.tool.rotation == robot.elastic.tool.rotation);
  TEST_ASSERT_TRUE(again.elastic.tool.position == robot.elastic.tool.position);
  TEST_ASSERT_TRUE(again.link_inertia.back() == robot.link_inertia.back());

  flexcomp::test::put(folder / "tools.yaml",
                      "schema: flexcomp/tools/1\ntools:\n  short: {xyz: [0, 0, 0.1]}\n"
                      "  long: {xyz: [0, 0, 0.3]}\n");
  const flexcomp::model::Tool longer = flexcomp::model::load_tool(folder / "tools.yaml", "long");
  put_arm(folder);
  const Robot bare = load_robot(folder / "robot.yaml");
  const Robot swapped = load_robot(folder / "again.yaml", longer);
  const Vector3<double> along = bare.elastic.tool.rotation.transpose() *
                                (swapped.elastic.tool.position - bare.elastic.tool.position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-15, 0.3, along.z());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, bare.elastic.joints.back().mass,
                            swapped.elastic.joints.back().mass);
}

void a_written_robot_is_read_back_as_it_was() {
  const ScratchFolder folder;
  const Robot robot = full_robot(folder);
  write_robot(folder / "updated.yaml", robot);
  assert_same_yaml(robot, load_robot(folder / "updated.yaml"));
  write_robot(folder / "again.yaml", load_robot(folder / "updated.yaml"));
  TEST_ASSERT_EQUAL_STRING(content_of(folder / "updated.yaml").c_str(),
                           content_of(folder / "again.yaml").c_str());
}

void what_is_zero_is_not_written() {
  const ScratchFolder folder;
  put_arm(folder, {"payload: {mass: 7}\n", ""});
  write_robot(folder / "robot.yaml", load_robot(folder / "robot.yaml"));
  TEST_ASSERT_EQUAL_STRING(
      "schema: flexcomp/robot/1\n"
      "name: An arm\n"
      "urdf: arm.urdf\n"
      "base_link: base\n"
      "tool_link: tool\n"
      "gravity: [0, 0, -9.81]\n"
      "joints:\n"
      "  j1:\n"
      "    compliance: 1.0e-06\n"
      "  j2:\n"
      "    compliance: 2.0e-06\n"
      "    backlash: 0.0001\n"
      "  j3:\n"
      "    compliance: 3.0e-06\n"
      "  j4:\n"
      "    compliance: 4.0e-06\n"
      "  j5:\n"
      "    compliance: 5.0e-06\n"
      "  j6:\n"
      "    compliance: 6.0e-06\n",
      content_of(folder / "robot.yaml").c_str());
}

void a_robot_written_elsewhere_still_finds_its_urdf() {
  const ScratchFolder folder;
  const Robot robot = full_robot(folder);
  fs::create_directories(folder / "out/deep");
  write_robot(folder / "out/deep/robot.yaml", robot);
  TEST_ASSERT_TRUE(content_of(folder / "out/deep/robot.yaml").find("urdf: ../../arm.urdf\n") !=
                   std::string::npos);
  const Robot moved = load_robot(folder / "out/deep/robot.yaml");
  TEST_ASSERT_TRUE(fs::equivalent(robot.urdf, moved.urdf));
  TEST_ASSERT_TRUE(model_hash(six_axis_model(robot)) == model_hash(six_axis_model(moved)));
}

void a_robot_that_cannot_be_is_not_written() {
  const ScratchFolder folder;
  const Robot robot = full_robot(folder);
  Robot soft = robot;
  soft.elastic.joints[3].compliance = std::numeric_limits<double>::quiet_NaN();
  Robot rough = robot;
  rough.dynamics[0].coulomb = -1;
  for (const Robot& impossible : {soft, rough}) {
    try {
      write_robot(folder / "updated.yaml", impossible);
      TEST_FAIL_MESSAGE("written");
    } catch (const std::invalid_argument&) {
      TEST_ASSERT_FALSE(fs::exists(folder / "updated.yaml"));
    }
  }
}

void a_place_that_cannot_be_written_is_refused() {
  const ScratchFolder folder;
  const Robot robot = full_robot(folder);
  try {
    write_robot(folder / "nowhere/robot.yaml", robot);
    TEST_FAIL_MESSAGE("written");
  } catch (const InputError& error) {
    TEST_ASSERT_EQUAL_STRING(((folder / "nowhere/robot.yaml").string() +
                              ": cannot be written: No such file or directory")
                                 .c_str(),
                             error.what());
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(keys_that_are_left_out_are_zero);
  RUN_TEST(limits_and_axes_come_from_the_urdf);
  RUN_TEST(odd_axes_and_fixed_joints_move_the_tool_as_in_kdl);
  RUN_TEST(what_hangs_on_a_link_is_part_of_its_body);
  RUN_TEST(a_tool_in_the_yaml_is_one_in_the_urdf);
  RUN_TEST(a_tool_is_written_as_it_was_read_and_gives_way_to_another);
  RUN_TEST(a_written_robot_is_read_back_as_it_was);
  RUN_TEST(what_is_zero_is_not_written);
  RUN_TEST(a_robot_written_elsewhere_still_finds_its_urdf);
  RUN_TEST(a_robot_that_cannot_be_is_not_written);
  RUN_TEST(a_place_that_cannot_be_written_is_refused);
  return UNITY_END();
}
