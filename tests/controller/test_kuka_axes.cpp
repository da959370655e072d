#include "controller/kuka_axes.hpp"
#include "core/test_robots.hpp"
#include "flexcomp/chain.hpp"
#include "model/robot.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::controller::kuka_axes;

namespace {

constexpr double kPi = 3.14159265358979323846;
using Model = RobotModel<double, 6>;

/// The same robot with a joint that counts from elsewhere, or the other way.
Model counted_from(Model model, std::size_t joint, double angle) {
  Joint<double>& changed = model.joints[joint];
  changed.origin.rotation = changed.origin.rotation * axis_rotation<double>(changed.axis, angle);
  return model;
}

Model counted_backwards(Model model, std::size_t joint) {
  model.joints[joint].axis = -model.joints[joint].axis;
  return model;
}

/// Is the robot where KUKA's angles say, whatever its URDF counts?
void check_same_place(const Model& reference, const Model& other) {
  const std::optional<AxisConvention> axes = kuka_axes(other);
  TEST_ASSERT_TRUE(axes.has_value());
  for (const AxisAngles& angles :
       {AxisAngles{0, 0, 0, 0, 0, 0}, AxisAngles{10, -80, 95, 20, -35, 50},
        AxisAngles{-120, -20, -40, 170, 100, -200}}) {
    const JointAngles expected = AxisConvention().to_joints(angles);
    const JointAngles joints = axes->to_joints(angles);
    const auto at = [](const Model& model, const JointAngles& q) {
      return forward_kinematics<double, 6>(model,
                                           Eigen::Map<const JointVector<double, 6>>(q.data()))
          .tcp;
    };
    const Pose<double> a = at(reference, expected);
    const Pose<double> b = at(other, joints);
    TEST_ASSERT_TRUE((a.position - b.position).norm() < 1e-7);
    TEST_ASSERT_TRUE((a.rotation - b.rotation).norm() < 1e-7);
  }
}

void the_robots_that_come_with_flexcomp_count_as_a_kuka_does() {
  for (const char* name : {"kr100", "kr270", "kr360", "kr500"}) {
    const model::Robot robot =
        model::load_robot(std::string(FLEXCOMP_ROBOTS) + "/" + name + "/robot.yaml");
    const std::optional<AxisConvention> axes = kuka_axes(model::six_axis_model(robot));
    TEST_ASSERT_TRUE_MESSAGE(axes.has_value(), name);
    for (std::size_t i = 0; i < 6; ++i) {
      TEST_ASSERT_EQUAL_DOUBLE(1, axes->sign[i]);
      TEST_ASSERT_EQUAL_DOUBLE(0, axes->zero[i]);
    }
  }
}

void a_joint_that_turns_the_other_way_is_seen() {
  const Model kuka = test::kr270<double>();
  for (std::size_t joint = 0; joint < 6; ++joint) {
    const Model other = counted_backwards(kuka, joint);
    check_same_place(kuka, other);
    for (std::size_t i = 0; i < 6; ++i) {
      TEST_ASSERT_EQUAL_DOUBLE(i == joint ? -1 : 1, kuka_axes(other)->sign[i]);
    }
  }
}

/// As in URDFs whose zero is the upright arm with the forearm level.
void joints_that_count_from_another_posture_are_seen() {
  const Model kuka = test::kr270<double>();
  const Model upright = counted_from(counted_from(kuka, 1, -kPi / 2), 2, kPi / 2);
  check_same_place(kuka, upright);
  TEST_ASSERT_DOUBLE_WITHIN(1e-5, -90, kuka_axes(upright)->zero[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-5, 90, kuka_axes(upright)->zero[2]);
  check_same_place(kuka, counted_from(kuka, 4, kPi / 2));
  check_same_place(kuka, counted_backwards(counted_from(upright, 4, 0.3), 1));
}

void a_robot_that_is_built_otherwise_is_not_taken_for_a_kuka() {
  Model turned = test::kr270<double>();
  turned = counted_from(turned, 0, 0.3);  // its zero of A1 is elsewhere
  TEST_ASSERT_FALSE(kuka_axes(turned).has_value());
  TEST_ASSERT_FALSE(kuka_axes(counted_from(test::kr270<double>(), 3, 0.3)).has_value());
  Model scara = test::kr270<double>();
  scara.joints[1].axis = Vector3<double>::UnitZ();
  TEST_ASSERT_FALSE(kuka_axes(scara).has_value());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_robots_that_come_with_flexcomp_count_as_a_kuka_does);
  RUN_TEST(a_joint_that_turns_the_other_way_is_seen);
  RUN_TEST(joints_that_count_from_another_posture_are_seen);
  RUN_TEST(a_robot_that_is_built_otherwise_is_not_taken_for_a_kuka);
  return UNITY_END();
}
