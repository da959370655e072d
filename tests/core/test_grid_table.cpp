#include <random>
#include <vector>

#include "cases.hpp"
#include "core/test_robots.hpp"
#include "flexcomp/table_builder.hpp"
#include "unity_main.hpp"

using namespace flexcomp;
using flexcomp::test::cases;
using flexcomp::test::kr270;
using flexcomp::test::kr270_with_everything;

namespace {

using Ranges = GridRange<double>[4];

struct Built {
  std::vector<std::uint32_t> words = std::vector<std::uint32_t>(1 << 20);
  std::size_t size = 0;
  Result result;
  Table table;

  Built(const RobotModel<double, 6>& model, const Ranges& ranges, double tolerance) {
    result = build_grid_table<double, 6>(model, ranges, {1600, 20, tolerance, tolerance, 0},
                                         words.data(), 4 * words.size(), &size);
    if (result == Result::ok) {
      TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), size, &table));
    }
  }
};

constexpr Ranges kArm = {{-1.4, -1.0}, {1.0, 1.6}, {0.25, 0.25}, {0.75, 0.75}};
constexpr Ranges kArmAndWrist = {{-1.3, -1.2}, {1.2, 1.3}, {0.2, 0.3}, {0.7, 0.8}};

/// 100,000 random postures in the boxes, joints 1 and 6 anywhere.
void check_certificate(const RobotModel<double, 6>& model, const Ranges& ranges, double tolerance) {
  const Built built(model, ranges, tolerance);
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  const TableHeader& header = built.table.header();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  TableCursor cursor;
  TableError<double> worst;
  for (int i = 0; i < cases(100000); ++i) {
    const double place[4] = {uniform(random), uniform(random), uniform(random), uniform(random)};
    JointVector<double, 6> q = chart_angles<double, 6>(built.table, place);
    q[0] = 6 * uniform(random) - 3;
    q[5] = 12 * uniform(random) - 6;
    const TableError<double> error = table_error_at<double, 6>(model, built.table, q, &cursor);
    worst.position = std::max(worst.position, error.position);
    worst.orientation = std::max(worst.orientation, error.orientation);
  }
  TEST_ASSERT_TRUE(worst.position <= static_cast<double>(header.position_error));
  TEST_ASSERT_TRUE(worst.orientation <= static_cast<double>(header.orientation_error));
  TEST_ASSERT_TRUE(static_cast<double>(header.position_error) <= tolerance);
  TEST_ASSERT_TRUE(worst.position > 0.1 * static_cast<double>(header.position_error));
}

void no_posture_in_a_grid_over_the_arm_exceeds_the_certificate() {
  check_certificate(kr270<double>(), kArm, 5e-6);
}

void nor_in_a_grid_over_arm_and_wrist() { check_certificate(kr270<double>(), kArmAndWrist, 2e-5); }

/// Weight along axis 1 turns with it; payload and last link lie on axis 6.
void nor_with_weight_balanced_about_the_last_axis() {
  RobotModel<double, 6> model = kr270<double>();
  const double masses[] = {340, 260, 180, 60, 40, 10};
  for (std::size_t i = 0; i < 6; ++i) {
    model.joints[i].mass = masses[i];
    model.joints[i].center_of_mass = Vector3<double>(0.1, i < 5 ? 0.05 : 0.0, 0);
  }
  model.gravity = Vector3<double>(0, 0, -9.81);
  model.payload_mass = 100;
  model.payload_center = Vector3<double>(0.1, 0, 0);
  check_certificate(model, kArm, 2e-5);
}

void models_that_turn_with_joints_1_or_6_are_refused() {
  const auto refused = [](const RobotModel<double, 6>& model) {
    return Built(model, kArm, 1e-5).result == Result::chart_not_invariant;
  };
  RobotModel<double, 6> model = kr270<double>();
  model.base_compliance[0] = 1e-8;
  TEST_ASSERT_TRUE(refused(model));
  model = kr270<double>();
  model.tool.position.y() = 0.1;
  TEST_ASSERT_TRUE(refused(model));
  model = kr270<double>();
  model.payload_mass = 50;
  model.payload_center = Vector3<double>(0, 0.1, 0);
  model.gravity = Vector3<double>(0, 0, -9.81);
  TEST_ASSERT_TRUE(refused(model));
  model = kr270<double>();
  model.joints[1].mass = 200;
  model.gravity = Vector3<double>(0, 1, -9.75);
  TEST_ASSERT_TRUE(refused(model));
  TEST_ASSERT_TRUE(refused(kr270_with_everything<double>()));
}

void outside_the_boxes_the_nearest_edge_counts() {
  const Built built(kr270<double>(), kArm, 1e-5);
  TableCursor cursor;
  JointVector<double, 6> q;
  q << 0.3, -1.4, 1.3, 0.25, 0.75, 1;
  const auto inside = look_up<double, 6>(built.table, q, &cursor);
  TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0, inside.outside);
  q[1] = -1.6;
  const auto outside = look_up<double, 6>(built.table, q, &cursor);
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.2, outside.outside);
  TEST_ASSERT_TRUE((outside.jacobian - inside.jacobian).cwiseAbs().maxCoeff() < 1e-7);
}

void a_joint_that_is_not_in_the_grid_must_stand_where_it_was_fixed() {
  const Built built(kr270<double>(), kArm, 1e-5);
  TableCursor cursor;
  JointVector<double, 6> q;
  q << 0.3, -1.2, 1.3, 0.25, 0.85, 1;
  TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.1, (look_up<double, 6>(built.table, q, &cursor).outside));
}

/// A lookup table of joints needs no cursor.
void a_cursor_is_left_as_it_is() {
  const Built built(kr270<double>(), kArm, 1e-5);
  TableCursor cursor{7, 3};
  const JointVector<double, 6> q = JointVector<double, 6>::Zero();
  locate<double, 6>(built.table, q, &cursor);
  TEST_ASSERT_EQUAL(7, cursor.segment);
  TEST_ASSERT_EQUAL(3, cursor.searched);
}

void a_fault_of_the_arguments_goes_before_all_else() {
  std::vector<std::uint32_t> words(100);
  std::size_t size = 0;
  TEST_ASSERT_EQUAL(Result::bad_argument,
                    (build_grid_table<double, 6>(kr270<double>(), kArm, {1600, 20, 1e-5, 1e-5, 0},
                                                 nullptr, 400, &size)));
  TEST_ASSERT_EQUAL(Result::tolerance_not_met,
                    (build_grid_table<double, 6>(kr270<double>(), kArm, {1600, 20, 1e-5, 1e-16, 0},
                                                 words.data(), 400, &size)));
  // More cells than a grid may have, whatever the memory.
  const Ranges wide = {{-1000, 0}, {0, 1000}, {0.25, 0.25}, {0.75, 0.75}};
  TEST_ASSERT_EQUAL(Result::tolerance_not_met,
                    (build_grid_table<double, 6>(kr270<double>(), wide, {1600, 20, 1e-6, 1e-6, 0},
                                                 words.data(), 400, &size)));
}

/// Where the position alone would do with fewer nodes.
void the_orientation_too_is_held_to_its_tolerance() {
  const Ranges small = {{-1.25, -1.15}, {1.25, 1.35}, {0.3, 0.3}, {0.8, 0.8}};
  std::vector<std::uint32_t> words(1 << 18);
  std::size_t coarse = 0;
  std::size_t fine = 0;
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_grid_table<double, 6>(kr270<double>(), small, {1600, 20, 1e-3, 1e-3, 0},
                                                 words.data(), 4 * words.size(), &coarse)));
  TEST_ASSERT_EQUAL(Result::ok,
                    (build_grid_table<double, 6>(kr270<double>(), small, {1600, 20, 1e-3, 1e-6, 0},
                                                 words.data(), 4 * words.size(), &fine)));
  TEST_ASSERT_TRUE(fine > coarse);
}

/// The TCP is two metres from the arm's joints.
void a_force_bends_the_arm_more_and_asks_for_more_nodes_than_as_large_a_moment() {
  const Ranges small = {{-1.25, -1.15}, {1.25, 1.35}, {0.3, 0.3}, {0.8, 0.8}};
  const auto nodes = [&](double force, double moment) {
    std::vector<std::uint32_t> words(1 << 18);
    std::size_t size = 0;
    TEST_ASSERT_EQUAL(Result::ok, (build_grid_table<double, 6>(
                                      kr270<double>(), small, {force, moment, 2e-6, 1e-3, 0},
                                      words.data(), 4 * words.size(), &size)));
    Table table;
    TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), size, &table));
    return table.header().node_count;
  };
  TEST_ASSERT_TRUE(nodes(1600, 1) > nodes(1, 1600));
}

void what_a_tick_reads_is_the_response_of_the_entry() {
  const Built built(kr270<double>(), kArmAndWrist, 2e-5);
  Wrench<double> wrench;
  wrench << 440, 1370, 635, 3, -8, 10.5;
  for (int place = 0; place < 8; ++place) {
    const double places[4] = {0.11 * place, 0.5, 0.9 - 0.1 * place, 0.3};
    const JointVector<double, 6> q = chart_angles<double, 6>(built.table, places);
    double outside = 1;
    const auto read = look_up_response<double, 6>(built.table, q, wrench, nullptr, &outside);
    const auto entry = look_up<double, 6>(built.table, q, nullptr);
    const auto expected = respond<double, 6>(built.table, entry, wrench);
    TEST_ASSERT_EQUAL_DOUBLE(entry.outside, outside);
    TEST_ASSERT_TRUE(read.deflection == expected.deflection);
    TEST_ASSERT_TRUE(read.correction == expected.correction);
    const auto exact = deflection<double, 6>(kr270<double>(), q, wrench).tcp;
    TEST_ASSERT_TRUE((read.deflection - exact).head<3>().norm() < 2e-5);
  }
}

void what_cannot_be_built_is_named() {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Ranges none = {{0, 0}, {0, 0}, {0, 0}, {0, 0}};
  const Ranges backwards = {{1, 0}, {0, 1}, {0, 0}, {0, 0}};
  const Ranges unknown = {{0, nan}, {0, 1}, {0, 0}, {0, 0}};
  const Ranges from_unknown = {{nan, 0}, {0, 1}, {0, 0}, {0, 0}};
  TEST_ASSERT_EQUAL(Result::bad_argument, Built(kr270<double>(), from_unknown, 1e-5).result);
  TEST_ASSERT_EQUAL(Result::bad_argument, Built(kr270<double>(), none, 1e-5).result);
  TEST_ASSERT_EQUAL(Result::bad_argument, Built(kr270<double>(), backwards, 1e-5).result);
  TEST_ASSERT_EQUAL(Result::bad_argument, Built(kr270<double>(), unknown, 1e-5).result);
  TEST_ASSERT_EQUAL(Result::buffer_too_small, Built(kr270<double>(), kArm, 1e-8 * 5).result);
  TEST_ASSERT_EQUAL(Result::tolerance_not_met, Built(kr270<double>(), kArm, 1e-12).result);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(no_posture_in_a_grid_over_the_arm_exceeds_the_certificate);
  RUN_TEST(nor_in_a_grid_over_arm_and_wrist);
  RUN_TEST(nor_with_weight_balanced_about_the_last_axis);
  RUN_TEST(models_that_turn_with_joints_1_or_6_are_refused);
  RUN_TEST(outside_the_boxes_the_nearest_edge_counts);
  RUN_TEST(a_joint_that_is_not_in_the_grid_must_stand_where_it_was_fixed);
  RUN_TEST(a_cursor_is_left_as_it_is);
  RUN_TEST(a_fault_of_the_arguments_goes_before_all_else);
  RUN_TEST(the_orientation_too_is_held_to_its_tolerance);
  RUN_TEST(a_force_bends_the_arm_more_and_asks_for_more_nodes_than_as_large_a_moment);
  RUN_TEST(what_a_tick_reads_is_the_response_of_the_entry);
  RUN_TEST(what_cannot_be_built_is_named);
  return UNITY_END();
}
