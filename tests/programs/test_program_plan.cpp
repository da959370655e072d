#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "flexcomp/chain.hpp"
#include "model/robot.hpp"
#include "planning/motion_fit.hpp"
#include "planning/program_plan.hpp"
#include "programs/gcode_reader.hpp"
#include "programs/rapid_reader.hpp"
#include "unity_main.hpp"

using flexcomp::InputError;
using flexcomp::Pose;
using flexcomp::RobotModel;
using flexcomp::Vector3;
using namespace flexcomp::planning;
using namespace flexcomp::programs;

namespace {

const RobotModel<double, 6>& kr270() {
  static const RobotModel<double, 6> model = flexcomp::model::six_axis_model(
      flexcomp::model::load_robot(FLEXCOMP_ROBOTS "/kr270/robot.yaml"));
  return model;
}

const Program& job() {
  static const Program program = gcode_program(
      "p.nc",
      "G0 X0 Y0 Z20\nM3\nG1 Z-2 F900\nG1 X30 F3000\nG3 X-30 Y0 I-30\nG1 X30 Y-40\nM5\nG0 Z50\n");
  return program;
}

ProgramPlan plan_at(const Vector3<double>& place) {
  ProgramPlan plan;
  plan.frame = Pose<double>{flexcomp::Matrix3<double>::Identity(), place};
  plan.cutting << 100, 200, 300, 1, 2, 3;
  return plan;
}

PlannedProgram planned(const ProgramPlan& plan) {
  return plan_program(kr270(), job(), plan, [](std::size_t, std::size_t) {});
}

Pose<double> tcp(const PlannedProgram& of, Eigen::Index row) {
  return flexcomp::forward_kinematics<double, 6>(kr270(), of.recording.q_cmd->row(row).transpose())
      .tcp;
}

void the_tcp_passes_the_programs_points_in_its_frame() {
  const ProgramPlan plan = plan_at({1.5, 0.2, 0.8});
  const PlannedProgram at = planned(plan);
  const auto points = sample(job(), plan.sampling);
  TEST_ASSERT_EQUAL(points.size(), at.recording.size());
  for (Eigen::Index row = 0; row < at.recording.size(); ++row) {
    const Pose<double>& point = points[static_cast<std::size_t>(row)].pose;
    const Pose<double> found = tcp(at, row);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (found.position - (*plan.frame * point).position).norm());
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1, found.rotation.col(2).dot(point.rotation.col(2)));
  }
}

void arcs_are_sampled_within_the_chord_error() {
  const auto points = sample(job(), PathSampling{});
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i].motion == 3 && points[i - 1].motion == 3) {
      const Vector3<double> middle = (points[i].pose.position + points[i - 1].pose.position) / 2;
      TEST_ASSERT_DOUBLE_WITHIN(5.01e-6, 0.030, middle.head<2>().norm());
      TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.030, points[i].pose.position.head<2>().norm());
      TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0, points[i].feed_direction.dot(points[i].pose.position));
    }
  }
}

void the_wrench_turns_with_the_feed_where_it_cuts() {
  const PlannedProgram at = planned(plan_at({1.5, 0.2, 0.8}));
  const auto& lines = *at.recording.program_line;
  for (Eigen::Index row = 0; row < at.recording.size(); ++row) {
    const Eigen::Matrix<double, 6, 1> wrench = at.recording.wrench->row(row).transpose();
    Eigen::Matrix<double, 6, 1> expected = Eigen::Matrix<double, 6, 1>::Zero();
    if (lines(row, 0) == 4) {  // along x: to the left is y, up the spindle z
      expected << 100, 200, 300, 1, 2, 3;
    } else if (lines(row, 0) == 3) {  // down: what is across the tool's axis has no direction
      expected << 0, 0, 300, 0, 0, 3;
    } else if (lines(row, 0) == 5 || lines(row, 0) == 6) {
      TEST_ASSERT_DOUBLE_WITHIN(1e-9, std::sqrt(140000.0), wrench.head<3>().norm());
      continue;
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (wrench - expected).norm());
  }
}

void feeds_accelerations_and_joint_speeds_are_kept() {
  ProgramPlan plan = plan_at({1.5, 0.2, 0.8});
  plan.limits.acceleration = 1;
  plan.limits.joint_speed.setConstant(0.2);
  const PlannedProgram at = planned(plan);
  double fastest = 0;
  double before = 0;
  for (Eigen::Index row = 1; row < at.recording.size(); ++row) {
    const double step = at.recording.time[row] - at.recording.time[row - 1];
    const double speed = (tcp(at, row).position - tcp(at, row - 1).position).norm() / step;
    const auto line = static_cast<int>((*at.recording.program_line)(row, 0));
    const double feed = line == 3 ? 0.015 : line == 8 ? plan.limits.rapid : 0.05;
    TEST_ASSERT_TRUE(speed <= feed * (1 + 1e-9));
    const double joint =
        (at.recording.q_cmd->row(row) - at.recording.q_cmd->row(row - 1)).cwiseAbs().maxCoeff() /
        step;
    TEST_ASSERT_TRUE(joint <= 0.2 * (1 + 1e-9));
    if (row > 1) {
      TEST_ASSERT_TRUE(std::abs(speed - before) <= 2.0 * step + 1e-6);
    }
    before = speed;
    fastest = std::max(fastest, speed);
  }
  TEST_ASSERT_TRUE(fastest > 0.049);
}

/// From the program's first point to its last, s.
double seconds_of(const Program& program) {
  const PlannedProgram at =
      plan_program(kr270(), program, plan_at({1.6, 0, 0.8}), [](std::size_t, std::size_t) {});
  return at.recording.time[at.recording.size() - 1];
}

double seconds_of(const std::string& text) {
  return seconds_of(gcode_program("p.nc", "G0 X0 Y0 Z10 A0\n" + text));
}

/// NISTIR 6556: F2 in G93 is half a minute; in G94 it is of X, Y and Z where they move, else
/// degrees a minute. To speed up and slow down takes a few hundredths of a second.
void feeds_take_the_time_of_the_standard_while_the_tool_turns() {
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 30, seconds_of("G93 G1 X10 A30 F2\n"));
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 30, seconds_of("G93 G1 A10 F2\n"));
  TEST_ASSERT_DOUBLE_WITHIN(0.06, 1, seconds_of("G94 G1 X10 A30 F600\n"));
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 3, seconds_of("G94 G1 A30 F600\n"));
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 60, seconds_of("G1 X10 F10\n"));
}

/// As in RAPID's v5, which has 500 degrees a second: 50 mm take 10 s, and the turn governs where it
/// takes longer.
void the_slower_of_feed_and_turn_governs() {
  Program program = rapid_program(
      "p.mod",
      "MODULE p\nPROC main()\n"
      "MoveJ [[0,0,10],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,fine,tool0;\n"
      "MoveL [[50,0,10],[0,0.9659258,0.2588190,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v5,fine,"
      "tool0;\nENDPROC\nENDMODULE\n");
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 10, seconds_of(program));
  program.motions[1].turn_feed = 1.5 * kDegree;
  TEST_ASSERT_DOUBLE_WITHIN(0.05, 20, seconds_of(program));
}

/// Straight ahead of the robot with the tool's x axis along the base's, joint 5 would stand near
/// its singularity in some of the turns: the turn that is chosen is no worse than any other.
void the_tools_turn_keeps_away_from_limits_and_singularities() {
  const ProgramPlan plan = plan_at({1.7, 0, 1.2});
  const PlannedProgram best = planned(plan);
  Program fixed = job();
  fixed.has_free_spin = false;
  const PlannedProgram plain = plan_program(kr270(), fixed, plan, [](std::size_t, std::size_t) {});
  const auto worst = [](const FollowedPath& path) {
    return std::min(path.joint_margin, 3 * path.singular_value);
  };
  TEST_ASSERT_TRUE(worst(best.path) >= worst(plain.path));
  TEST_ASSERT_TRUE(worst(best.path) > 0.3);
}

void without_a_frame_one_in_reach_is_found() {
  ProgramPlan plan = plan_at({0, 0, 0});
  plan.frame.reset();
  const PlannedProgram at = planned(plan);
  TEST_ASSERT_TRUE(at.path.frame.position.x() > 0.5);
}

void what_is_out_of_reach_is_refused_with_its_line() {
  try {
    planned(plan_at({2.9, 0, 0.8}));
    TEST_FAIL_MESSAGE("accepted");
  } catch (const InputError& error) {
    TEST_ASSERT_EQUAL_STRING_LEN("p.nc:1: cannot be reached", error.what(), 25);
  }
}

Motion straight_to(double x) {
  Motion motion;
  motion.kind = MotionKind::linear;
  motion.end.position.x() = x;
  return motion;
}

void points_are_added_only_where_the_correction_bends() {
  std::vector<Pose<double>> poses(101);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double x = 0.001 * static_cast<double>(i);
    poses[i].position = {x, 1e-4, 0};
  }
  TEST_ASSERT_EQUAL(1, fit_motion(straight_to(0.1), poses, 0, 100, 1e-6).size());
  for (std::size_t i = 40; i < poses.size(); ++i) {  // a bend at one point
    poses[i].position.z() = 1e-3 * (poses[i].position.x() - 0.04);
  }
  const std::vector<Motion> bent = fit_motion(straight_to(0.1), poses, 0, 100, 1e-6);
  TEST_ASSERT_EQUAL(2, bent.size());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.04, bent[0].end.position.x());
  TEST_ASSERT_EQUAL(1, fit_motion(straight_to(0.1), poses, 0, 100, 1e-4).size());
}

void a_turning_correction_counts_as_well() {
  std::vector<Pose<double>> poses(3);
  for (std::size_t i = 0; i < 3; ++i) {
    poses[i].position.x() = 0.05 * static_cast<double>(i);
  }
  poses[1].rotation = Eigen::AngleAxisd(1e-3, Vector3<double>::UnitY()).toRotationMatrix();
  TEST_ASSERT_EQUAL(2, fit_motion(straight_to(0.1), poses, 0, 2, 5e-5).size());
  TEST_ASSERT_EQUAL(1, fit_motion(straight_to(0.1), poses, 0, 2, 2e-4).size());
}

void a_circle_stays_arcs() {
  std::vector<Pose<double>> poses(361);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double angle = static_cast<double>(i) * M_PI / 180;
    poses[i].position = {0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.002};
  }
  poses.back() = poses.front();
  Motion circle;
  circle.kind = MotionKind::circular;
  circle.end = poses.back();
  circle.arc.angle = 2 * M_PI;
  const std::vector<Motion> arcs = fit_motion(circle, poses, 0, 360, 1e-6);
  TEST_ASSERT_EQUAL(2, arcs.size());
  for (const Motion& arc : arcs) {
    TEST_ASSERT_TRUE(arc.kind == MotionKind::circular);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, M_PI, arc.arc.angle);
  }
}

/// Where the force sets in, a correction jumps against the motion. The circle through three points
/// there leads far off between them.
void no_arc_leads_where_no_pose_is() {
  std::vector<Pose<double>> poses(3);
  poses[0].position = {0, 0, 0};
  poses[1].position = {-0.4e-3, -1.1e-3, 0};
  poses[2].position = {-0.4e-3, -0.7e-3, 0.1e-3};
  Motion quarter;
  quarter.kind = MotionKind::circular;
  quarter.end.position = {0, 5e-3, 5e-3};
  quarter.arc.center = {0, 0, 5e-3};
  quarter.arc.normal = Vector3<double>::UnitX();
  quarter.arc.angle = M_PI / 2;
  for (const Motion& one : fit_motion(quarter, poses, 0, 2, 5e-6)) {
    TEST_ASSERT_TRUE(one.kind == MotionKind::linear);
  }
}

/// A correction moves and bends a circle a little: it stays arcs.
void a_circle_that_is_corrected_stays_arcs() {
  std::vector<Pose<double>> poses(181);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double angle = static_cast<double>(i) * M_PI / 180;
    const double radius = 0.05 + 5e-4 * std::cos(angle);
    poses[i].position = {radius * std::cos(angle) + 1e-3, radius * std::sin(angle), 0};
  }
  Motion half;
  half.kind = MotionKind::circular;
  half.end.position = {-0.05, 0, 0};
  half.arc.angle = M_PI;
  const std::vector<Motion> arcs = fit_motion(half, poses, 0, 180, 5e-6);
  TEST_ASSERT_TRUE(arcs.size() <= 16);
  for (const Motion& one : arcs) {
    TEST_ASSERT_TRUE(one.kind == MotionKind::circular);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(the_tcp_passes_the_programs_points_in_its_frame);
  RUN_TEST(arcs_are_sampled_within_the_chord_error);
  RUN_TEST(the_wrench_turns_with_the_feed_where_it_cuts);
  RUN_TEST(feeds_accelerations_and_joint_speeds_are_kept);
  RUN_TEST(feeds_take_the_time_of_the_standard_while_the_tool_turns);
  RUN_TEST(the_slower_of_feed_and_turn_governs);
  RUN_TEST(the_tools_turn_keeps_away_from_limits_and_singularities);
  RUN_TEST(without_a_frame_one_in_reach_is_found);
  RUN_TEST(what_is_out_of_reach_is_refused_with_its_line);
  RUN_TEST(points_are_added_only_where_the_correction_bends);
  RUN_TEST(a_turning_correction_counts_as_well);
  RUN_TEST(a_circle_stays_arcs);
  RUN_TEST(no_arc_leads_where_no_pose_is);
  RUN_TEST(a_circle_that_is_corrected_stays_arcs);
  return UNITY_END();
}
