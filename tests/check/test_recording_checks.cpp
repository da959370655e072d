// Slips in a recording are told by name, and a recording without any says nothing.
#include <Eigen/Geometry>
#include <cstring>
#include <random>
#include <utility>

#include "check/recording_checks.hpp"
#include "check/times.hpp"
#include "effects/moving_robot.hpp"
#include "model/chain_kinematics.hpp"
#include "unity_main.hpp"

using Eigen::Index;
using flexcomp::check::Checks;
using flexcomp::check::Severity;
using flexcomp::recording::Recording;
using flexcomp::recording::Samples;

namespace {

namespace model = flexcomp::model;
namespace simulation = flexcomp::simulation;

/// A KR 270 with friction and a tool off its last axis, and what it shows while it swings, noise
/// included: as the simulation has it, which the checks of frames, units and signs do not use.
struct Measured {
  flexcomp::test::MovingRobot moving;
  Recording recording;

  Measured() {
    model::Robot& robot = moving.robot;
    robot.elastic.tool.position += Eigen::Vector3d(0.05, 0.12, -0.1);
    for (model::JointDynamics& joint : robot.dynamics) {
      joint.coulomb = 0.02 * joint.effort;
    }
    const simulation::Scene scene = moving.scene();
    const simulation::Prediction shown =
        simulation::predict(flexcomp::effects::machine_of(robot), {scene}).front();
    recording = moving.recording;
    recording.position = shown.channel[simulation::tcp_position];
    recording.tau = shown.channel[simulation::joint_torque];
    recording.q_link = *recording.q_meas + shown.channel[simulation::joint_deflection];
    add_noise(2e-5, &*recording.position);
    add_noise(10, &*recording.tau);
  }

  static void add_noise(double deviation, Samples* samples) {
    std::mt19937 random(5);
    std::normal_distribution<double> normal(0, deviation);
    for (Index row = 0; row < samples->rows(); ++row) {
      for (Index column = 0; column < samples->cols(); ++column) {
        (*samples)(row, column) += normal(random);
      }
    }
  }

  std::string names() const {
    std::string names;
    for (const auto& each : flexcomp::check::check_recording(&moving.robot, recording)) {
      if (each.severity != Severity::note) {
        names += (names.empty() ? "" : " ") + each.name;
      }
    }
    return names;
  }

  /// Angles of all groups, changed alike.
  template <typename Change>
  void change_angles(const Change& change) {
    for (auto* group : {&recording.q_cmd, &recording.q_meas, &recording.q_link}) {
      if (*group) {
        change(&**group);
      }
    }
  }

  Eigen::Matrix3d tool_at(Index row) const {
    const Eigen::VectorXd q = recording.q_meas->row(row).transpose();
    return forward_kinematics(moving.robot.elastic, q).tcp.rotation;
  }
};

void assert_named(const char* expected, const Measured& measured) {
  TEST_ASSERT_EQUAL_STRING(expected, measured.names().c_str());
}

void test_nothing_is_said_of_a_recording_without_slips() { assert_named("", Measured()); }

void test_positions_in_millimetres_or_inches() {
  Measured measured;
  *measured.recording.position *= 1000;
  assert_named("units.position", measured);
  *measured.recording.position /= 25.4;
  assert_named("units.position", measured);
}

void test_angles_in_degrees() {
  Measured measured;
  measured.change_angles([](Samples* q) { *q *= 57.29577951308232; });
  assert_named("units.angle units.angle units.angle", measured);  // of three groups
}

void test_times_in_milliseconds_or_microseconds() {
  Measured measured;
  measured.recording.time *= 1e3;
  assert_named("units.time", measured);
  measured.recording.time *= 1e3;
  assert_named("units.time", measured);
}

void test_axes_that_are_swapped_or_point_the_other_way() {
  Measured measured;
  measured.recording.position->col(0).swap(measured.recording.position->col(1));
  const Checks said = flexcomp::check::check_recording(&measured.moving.robot, measured.recording);
  assert_named("frame.base", measured);
  TEST_ASSERT_NOT_NULL(std::strstr(said.front().what.c_str(), "x and y are swapped"));
  Measured down;
  down.recording.position->col(2) *= -1;
  const Checks pointing = flexcomp::check::check_recording(&down.moving.robot, down.recording);
  TEST_ASSERT_NOT_NULL(std::strstr(pointing.front().what.c_str(), "z points down"));
}

void test_another_base_frame_is_told_by_its_turn_and_place() {
  Measured measured;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  *measured.recording.position =
      ((*measured.recording.position * turn.transpose()).rowwise() + Eigen::RowVector3d(1, 2, 3))
          .eval();
  const Checks said = flexcomp::check::check_recording(&measured.moving.robot, measured.recording);
  assert_named("frame.base", measured);
  TEST_ASSERT_NOT_NULL(std::strstr(said.front().what.c_str(), "turned by 28."));
  TEST_ASSERT_NOT_NULL(std::strstr(said.front().what.c_str(), "2, 3) m"));
}

void test_a_point_elsewhere_on_the_tool() {
  Measured measured;
  for (Index row = 0; row < measured.recording.size(); ++row) {
    measured.recording.position->row(row) +=
        (measured.tool_at(row) * Eigen::Vector3d(0.03, -0.05, 0.12)).transpose();
  }
  assert_named("tool.missing", measured);
}

void test_a_joint_whose_angle_is_turned() {
  for (const Index joint : {0, 3, 5}) {  // of joints 2 and 3 the limits tell
    Measured measured;
    measured.change_angles([&](Samples* q) { q->col(joint) *= -1; });
    assert_named("joint.sign", measured);
    measured.recording.position.reset();
    measured.recording.q_link.reset();
    if (joint != 0) {  // turned about an upright axis torques are the same but for their sign
      assert_named("joint.sign", measured);
    }
  }
}

/// The URDF counts joint 2 from the upright arm and joint 3 from the level forearm, and joints 1, 4
/// and 6 the other way; the recording is what a KUKA's panel shows.
void test_angles_counted_as_a_kuka_counts_them() {
  Measured measured;
  model::Robot& robot = measured.moving.robot;
  constexpr double kQuarterTurn = 1.5707963267948966;
  for (const unsigned joint : {1U, 2U}) {
    const double angle = joint == 1 ? -kQuarterTurn : kQuarterTurn;
    auto& changed = robot.elastic.joints[joint];
    changed.origin.rotation =
        changed.origin.rotation * Eigen::AngleAxisd(angle, changed.axis).toRotationMatrix();
    changed.lower -= angle;
    changed.upper -= angle;
  }
  for (const unsigned joint : {0U, 3U, 5U}) {
    auto& changed = robot.elastic.joints[joint];
    changed.axis = -changed.axis;
    changed.lower = -std::exchange(changed.upper, -changed.lower);
  }
  measured.recording.tau.reset();
  measured.recording.q_link.reset();
  const Checks said = flexcomp::check::check_recording(&robot, measured.recording);
  assert_named("joint.zero", measured);
  TEST_ASSERT_NOT_NULL(std::strstr(said.front().what.c_str(), "as a KUKA counts"));
  TEST_ASSERT_NOT_NULL(std::strstr(said.front().fix.c_str(),
                                   "signs -1, 1, 1, -1, 1, -1, zeros 0, -90, 90, 0, 0, 0"));
}

void test_two_joints_that_are_swapped() {
  Measured measured;
  measured.change_angles([](Samples* q) { q->col(3).swap(q->col(4)); });
  assert_named("joint.order", measured);
  measured.recording.position.reset();
  measured.recording.q_link.reset();
  assert_named("joint.order", measured);
}

void test_a_force_of_the_tool_on_the_work() {
  Measured measured;
  *measured.recording.wrench *= -1;
  assert_named("wrench.sign", measured);
  measured.recording.position.reset();
  measured.recording.q_link.reset();
  assert_named("wrench.sign", measured);
}

void test_a_force_in_the_frame_of_the_tool() {
  Measured measured;
  for (Index row = 0; row < measured.recording.size(); ++row) {
    const Eigen::Vector3d force = measured.recording.wrench->row(row).head<3>().transpose();
    measured.recording.wrench->row(row).head<3>() =
        (measured.tool_at(row).transpose() * force).transpose();
  }
  assert_named("wrench.frame", measured);
}

void test_torques_that_are_turned_or_of_the_motor_side() {
  Measured measured;
  measured.recording.tau->col(4) *= -1;
  assert_named("torque.sign", measured);
  Measured motors;
  *motors.recording.tau /= 150;
  assert_named("torque.unit", motors);
}

void test_that_a_rotor_on_a_coupled_wrist_turns_no_angle() {
  flexcomp::test::MovingRobot moving(800);
  // Joint 4 turns as joint 5 does, whose motor's place joint 6 takes.
  moving.recording.q_meas->col(3) = moving.recording.q_meas->col(4).array() - 0.3;
  moving.recording.q_cmd = moving.recording.q_meas;
  model::Robot truth = moving.robot;
  truth.transmission(5, 4) = -1;
  truth.dynamics[5].rotor_inertia = 3;
  truth.dynamics[5].coulomb = 5;
  moving.recording.wrench.reset();
  Recording shown = moving.recording;
  shown.position.reset();
  shown.q_link.reset();
  shown.tau = simulation::predict(flexcomp::effects::machine_of(truth), {moving.scene()})
                  .front()
                  .channel[simulation::joint_torque];
  Samples noise = Samples::Zero(shown.tau->rows(), shown.tau->cols());
  Measured::add_noise(0.1, &noise);
  noise.col(3) *= 10;  // else the torque of joint 4 alone tells
  *shown.tau +=
      noise.cwiseProduct(shown.tau->cwiseAbs().colwise().mean().replicate(noise.rows(), 1));
  for (const auto& each : flexcomp::check::check_recording(&moving.robot, shown)) {
    TEST_ASSERT_FALSE_MESSAGE(each.severity == Severity::error, each.name.c_str());
  }
}

void test_weight_that_the_model_leaves_out() {
  Measured measured;
  measured.moving.robot.elastic.gravity.setZero();
  measured.recording.position.reset();
  measured.recording.q_link.reset();
  assert_named("gravity.missing", measured);
}

void test_two_slips_at_once_are_both_told() {
  Measured measured;
  *measured.recording.position *= 1000;
  *measured.recording.wrench *= -1;
  assert_named("units.position wrench.sign", measured);
}

void test_another_robot_s_recording() {
  Measured measured;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (Index row = 0; row < measured.recording.size(); ++row) {
    measured.recording.position->row(row) << uniform(random), uniform(random), uniform(random);
  }
  measured.recording.tau.reset();
  measured.recording.q_link.reset();
  assert_named("model.other", measured);
}

void test_times_that_do_not_increase_are_counted_and_left_out() {
  flexcomp::recording::NumberTable table;
  table.file = "a.csv";
  table.columns = {"t", "x"};
  table.rows = {{0, 1}, {1, 2}, {1, 3}, {0.5, 4}, {2, 5}};
  table.lines = {2, 3, 4, 5, 6};
  const Checks said = flexcomp::check::check_order_of_times(&table);
  TEST_ASSERT_EQUAL_UINT(1, said.size());
  TEST_ASSERT_EQUAL_STRING("units.time", said.front().name.c_str());
  TEST_ASSERT_EQUAL_STRING("a.csv:4: time must increase: 1 row repeats a time and 1 goes back",
                           said.front().what.c_str());
  TEST_ASSERT_EQUAL_UINT(3, table.rows.size());
  TEST_ASSERT_EQUAL_UINT(6, table.line(2));
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(test_nothing_is_said_of_a_recording_without_slips);
  RUN_TEST(test_positions_in_millimetres_or_inches);
  RUN_TEST(test_angles_in_degrees);
  RUN_TEST(test_times_in_milliseconds_or_microseconds);
  RUN_TEST(test_axes_that_are_swapped_or_point_the_other_way);
  RUN_TEST(test_another_base_frame_is_told_by_its_turn_and_place);
  RUN_TEST(test_a_point_elsewhere_on_the_tool);
  RUN_TEST(test_a_joint_whose_angle_is_turned);
  RUN_TEST(test_angles_counted_as_a_kuka_counts_them);
  RUN_TEST(test_two_joints_that_are_swapped);
  RUN_TEST(test_a_force_of_the_tool_on_the_work);
  RUN_TEST(test_a_force_in_the_frame_of_the_tool);
  RUN_TEST(test_torques_that_are_turned_or_of_the_motor_side);
  RUN_TEST(test_that_a_rotor_on_a_coupled_wrist_turns_no_angle);
  RUN_TEST(test_weight_that_the_model_leaves_out);
  RUN_TEST(test_two_slips_at_once_are_both_told);
  RUN_TEST(test_another_robot_s_recording);
  RUN_TEST(test_times_that_do_not_increase_are_counted_and_left_out);
  return UNITY_END();
}
