#include <limits>
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
using flexcomp::test::loop_angles;

namespace {

constexpr double kTurn = 6.28318530717958647692;
constexpr int kPieces = 240;

template <typename Scalar>
using Program = std::vector<JointVector<Scalar, 6>>;

template <typename Scalar>
Program<Scalar> loop() {
  Program<Scalar> points;
  for (int i = 0; i <= kPieces; ++i) {
    points.push_back(loop_angles<Scalar>(kTurn * (i % kPieces) / kPieces));
  }
  return points;
}

template <typename Scalar>
TableRequirements<Scalar> requirements(Scalar tolerance) {
  return {Scalar(1600), Scalar(20), tolerance, tolerance, Scalar(0)};
}

template <typename Scalar>
struct Built {
  std::vector<std::uint32_t> words = std::vector<std::uint32_t>(1 << 18);
  std::size_t size = 0;
  Result result;
  Table table;

  Built(const RobotModel<Scalar, 6>& model, const Program<Scalar>& program,
        const TableRequirements<Scalar>& wanted) {
    result = build_path_table<Scalar, 6>(model, program.data(), program.size(), wanted,
                                         words.data(), 4 * words.size(), &size);
    if (result == Result::ok) {
      TEST_ASSERT_EQUAL(Result::ok, Table::open(words.data(), size, &table));
    }
  }
};

template <typename Scalar>
JointVector<Scalar, 6> on_program(const Program<Scalar>& program, double place) {
  const auto piece = static_cast<std::size_t>(place);
  return program[piece] + static_cast<Scalar>(place - static_cast<double>(piece)) *
                              (program[piece + 1] - program[piece]);
}

/// 100,000 random places on the program, with the cursor wherever a random jump left it.
template <typename Scalar>
void check_certificate(const RobotModel<Scalar, 6>& model, Scalar tolerance) {
  const Program<Scalar> program = loop<Scalar>();
  const Built<Scalar> built(model, program, requirements(tolerance));
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  const TableHeader& header = built.table.header();
  TEST_ASSERT_TRUE(static_cast<Scalar>(header.position_error) <= tolerance);
  TEST_ASSERT_TRUE(static_cast<Scalar>(header.orientation_error) <= tolerance);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, kPieces);
  TableCursor cursor;
  TableError<Scalar> worst;
  for (int i = 0; i < cases(100000); ++i) {
    const JointVector<Scalar, 6> q = on_program(program, uniform(random));
    locate<Scalar, 6>(built.table, q, &cursor);
    const TableError<Scalar> error = table_error_at<Scalar, 6>(model, built.table, q, &cursor);
    worst.position = std::max(worst.position, error.position);
    worst.orientation = std::max(worst.orientation, error.orientation);
  }
  TEST_ASSERT_TRUE(worst.position <= static_cast<Scalar>(header.position_error));
  TEST_ASSERT_TRUE(worst.orientation <= static_cast<Scalar>(header.orientation_error));
  // A bound far above what is found would be worth little.
  TEST_ASSERT_TRUE(worst.position > Scalar(0.3) * static_cast<Scalar>(header.position_error));
}

void no_place_on_the_program_exceeds_the_certificate() {
  check_certificate<double>(kr270<double>(), 1e-6);
}

void nor_with_every_kind_of_spring_and_weight() {
  check_certificate<double>(kr270_with_everything<double>(), 5e-6);
}

void nor_when_the_target_itself_builds_the_table() {
  check_certificate<float>(kr270<float>(), 2e-6F);
}

/// The error measure itself against brute force: wrenches on the border of the bound.
void the_worst_wrench_is_no_better_than_any_other() {
  const auto model = kr270_with_everything<double>();
  const Program<double> program = loop<double>();
  const Built<double> built(model, program, requirements(1e-4));
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int place = 0; place < 30; ++place) {
    const JointVector<double, 6> q = on_program(program, 7.77 * place);
    TableCursor cursor;
    locate<double, 6>(built.table, q, &cursor);
    const TableError<double> bound = table_error_at<double, 6>(model, built.table, q, &cursor);
    const auto entry = look_up<double, 6>(built.table, q, &cursor);
    const auto jacobian = geometric_jacobian<double, 6>(forward_kinematics(model, q));
    for (int i = 0; i < 200; ++i) {
      Vector3<double> force(normal(random), normal(random), normal(random));
      Vector3<double> moment(normal(random), normal(random), normal(random));
      Wrench<double> wrench;
      wrench << 1600 * force.normalized(), 20 * moment.normalized();
      const auto response = respond<double, 6>(built.table, entry, wrench);
      const Twist<double> exact = deflection<double, 6>(model, q, wrench).tcp;
      const Twist<double> predicted = response.deflection - exact;
      const Twist<double> left = jacobian * response.correction + exact;
      TEST_ASSERT_TRUE(predicted.head<3>().norm() <= bound.position);
      TEST_ASSERT_TRUE(predicted.tail<3>().norm() <= bound.orientation);
      TEST_ASSERT_TRUE(left.head<3>().norm() <= bound.position);
      TEST_ASSERT_TRUE(left.tail<3>().norm() <= bound.orientation);
    }
  }
}

template <typename Scalar>
void follow_either_way(Scalar tolerance) {
  const auto model = kr270<Scalar>();
  const Program<Scalar> program = loop<Scalar>();
  const Built<Scalar> built(model, program, requirements(tolerance));
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  TableCursor cursor;
  TableError<Scalar> worst;
  for (int i = 0; i < 4 * kPieces * 20; ++i) {
    // Two rounds forward, two back.
    const int step = i < 2 * kPieces * 20 ? i : 4 * kPieces * 20 - i;
    const JointVector<Scalar, 6> q = on_program(program, std::fmod(step / 20.0, kPieces));
    const TableError<Scalar> error = table_error_at<Scalar, 6>(model, built.table, q, &cursor);
    TEST_ASSERT_TRUE((look_up<Scalar, 6>(built.table, q, &cursor).outside == 0));
    worst.position = std::max(worst.position, error.position);
  }
  TEST_ASSERT_TRUE(worst.position <= static_cast<Scalar>(built.table.header().position_error));
}

void following_the_program_either_way_keeps_the_certificate() {
  follow_either_way<double>(1e-6);
  follow_either_way<float>(2e-6F);
}

void a_finer_tolerance_costs_about_the_square_root_in_nodes() {
  const Built<double> coarse(kr270<double>(), loop<double>(), requirements(1e-5));
  const Built<double> fine(kr270<double>(), loop<double>(), requirements(1e-7 * 2));
  const double ratio = static_cast<double>(fine.table.header().node_count) /
                       static_cast<double>(coarse.table.header().node_count);
  TEST_ASSERT_TRUE(ratio > 4 && ratio < 12);
}

/// Runs along a program without looking at the whole table again and checks every step, but for
/// `lost` ones at most that the lookup itself says are outside.
template <typename Scalar>
void check_run(const Program<Scalar>& program, Scalar tolerance, int lost, int a_piece = 1000) {
  const auto model = kr270<Scalar>();
  const Built<Scalar> built(model, program, requirements(tolerance));
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  TableCursor cursor;
  const auto steps = a_piece * static_cast<int>(program.size() - 1);
  for (int i = 0; i < steps; ++i) {
    const JointVector<Scalar, 6> q = on_program(program, static_cast<double>(i) / a_piece);
    if (look_up<Scalar, 6>(built.table, q, &cursor).outside > 0) {
      --lost;
      continue;
    }
    const TableError<Scalar> error = table_error_at<Scalar, 6>(model, built.table, q, &cursor);
    TEST_ASSERT_TRUE(error.position <= static_cast<Scalar>(built.table.header().position_error));
  }
  TEST_ASSERT_TRUE(lost >= 0);
}

template <typename Scalar>
Program<Scalar> zigzag(const std::vector<std::pair<Eigen::Index, double>>& moves) {
  Program<Scalar> points = {loop_angles<Scalar>(0)};
  for (const auto& [joint, angle] : moves) {
    points.push_back(points.back() +
                     static_cast<Scalar>(angle) * JointVector<Scalar, 6>::Unit(joint));
  }
  return points;
}

template <typename Scalar>
void turn_corners(Scalar tolerance) {
  check_run(zigzag<Scalar>({{1, 0.05}, {2, -0.08}, {1, 0.05}, {3, 0.1}}), tolerance, 0);
  Program<Scalar> spikes = zigzag<Scalar>({{1, 0.05}});
  for (const double bend : {0.5, 0.1, 0.02, -0.3}) {
    JointVector<Scalar, 6> back = spikes[spikes.size() - 2] - spikes.back();
    back[2] += static_cast<Scalar>(bend) * back.norm();
    spikes.push_back(spikes.back() + back);
  }
  check_run(spikes, tolerance, 0);
}

void corners_of_every_angle_keep_the_certificate() {
  turn_corners<double>(1e-7);
  turn_corners<float>(2e-6F);
}

/// Plunge, retract along the same line, move on: when the program turns off the lookup is still on
/// the plunge, and has to find the new segment a few ahead.
template <typename Scalar>
void plunge_and_retract(Scalar tolerance) {
  check_run(
      zigzag<Scalar>({{1, 0.05}, {2, 0.1}, {2, -0.1}, {3, 0.2}, {2, 0.1}, {2, -0.1}, {1, 0.03}}),
      tolerance, 10);
}

void a_program_that_runs_back_on_itself_is_followed() {
  plunge_and_retract<double>(2e-7);
  plunge_and_retract<float>(2e-6F);
}

/// Retracting further than it had plunged, or leaving where it came from, it comes before the
/// plunge as well as behind the retract: the segments between do not lead to the new one.
template <typename Scalar>
void turn_off_backwards(Scalar tolerance) {
  check_run(zigzag<Scalar>({{1, 0.05}, {2, 0.1}, {2, -0.1}, {2, -0.1}}), tolerance, 10);
  check_run(zigzag<Scalar>({{1, 0.05}, {2, 0.1}, {2, -0.1}, {1, -0.1}}), tolerance, 10);
}

void a_program_that_turns_off_backwards_is_found_again() {
  turn_off_backwards<double>(2e-7);
  turn_off_backwards<float>(2e-6F);
}

/// Two arcs in the plane of two joints that touch where the program turns back: it comes beside
/// itself. `first` and `second` are their curvatures (1/rad), to one side; `piece` is in rad.
template <typename Scalar>
Program<Scalar> cusp(double first, double second, double piece) {
  constexpr double kWay = 0.04;
  const auto pieces = static_cast<int>(kWay / piece);
  Program<Scalar> points;
  for (int i = -pieces; i <= pieces; ++i) {
    const double curvature = i < 0 ? first : second;
    const double turned = curvature * piece * std::abs(i);
    JointVector<Scalar, 6> q = loop_angles<Scalar>(0);
    q[1] += static_cast<Scalar>(std::sin(turned) / curvature);
    q[2] += static_cast<Scalar>((1 - std::cos(turned)) / curvature);
    points.push_back(q);
  }
  return points;
}

template <typename Scalar>
void come_back_beside_itself(Scalar tolerance, int lost) {
  for (const double piece : {0.002, 0.0005, 0.00002}) {
    for (const double second : {50.0, 25.0, 48.0, -20.0}) {
      check_run(cusp<Scalar>(50, second, piece), tolerance, lost,
                std::max(1, cases(static_cast<int>(piece / 2e-5))));
    }
  }
}

/// Where the pieces at the corner are short, no plane lies between the two arcs.
void a_program_that_comes_back_beside_itself_keeps_the_certificate() {
  come_back_beside_itself<double>(1e-5, 10);
  come_back_beside_itself<double>(1e-6, 10);
  come_back_beside_itself<float>(5e-6F, 10);
}

/// Turns of a bore, one beside the other: many segments may hold a place, but a lookup must not
/// leave the one that it is given for others that do not.
void a_place_that_was_located_is_looked_up_there() {
  Program<double> turns;
  for (int i = 0; i <= 3 * kPieces; ++i) {
    turns.push_back(loop_angles<double>(kTurn * (i % kPieces) / kPieces));
    turns.back()[3] += 2e-4 * i / kPieces;
  }
  for (const double tolerance : {1e-6, 1e-5, 1e-4}) {
    const Built<double> built(kr270<double>(), turns, requirements(tolerance));
    TEST_ASSERT_EQUAL(Result::ok, built.result);
    for (double place = 0; place < 3 * kPieces; place += 37.1 / cases(100)) {
      TableCursor cursor;
      const JointVector<double, 6> q = on_program(turns, place);
      locate<double, 6>(built.table, q, &cursor);
      TEST_ASSERT_TRUE((look_up<double, 6>(built.table, q, &cursor).outside == 0));
    }
  }
}

template <typename Scalar>
JointVector<Scalar, 6> middle_of(const Table& table, std::uint32_t segment) {
  using Node = Eigen::Map<const JointVector<float, 6>>;
  return ((Node(table.record(segment)) + Node(table.record(segment + 1))) / 2)
      .template cast<Scalar>();
}

/// From wherever the cursor is, to wherever the program is: no more look-ups than there are
/// segments.
template <typename Scalar>
void jump(const Program<Scalar>& program) {
  const Built<Scalar> built(kr270<Scalar>(), program, requirements(Scalar(2e-6)));
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  const std::uint32_t segments = built.table.header().node_count - 1;
  for (std::uint32_t from = 0; from < segments; ++from) {
    for (std::uint32_t to = 0; to < segments; ++to) {
      const JointVector<Scalar, 6> q = middle_of<Scalar>(built.table, to);
      TableCursor cursor;
      cursor.segment = from;
      std::uint32_t look_ups = 1;
      while (look_ups < segments && look_up<Scalar, 6>(built.table, q, &cursor).outside > 0) {
        ++look_ups;
      }
      TEST_ASSERT_TRUE((look_up<Scalar, 6>(built.table, q, &cursor).outside == 0));
    }
  }
}

void after_a_jump_any_segment_is_found_from_any_other() {
  jump<double>(loop<double>());
  jump<float>(loop<float>());
  jump<double>(zigzag<double>({{1, 0.05}, {2, 0.1}, {2, -0.1}, {2, -0.1}}));
}

/// After a jump along a line, one look-up makes up but a few segments: two by going there, four by
/// searching.
template <typename Scalar>
void jump_along_a_line() {
  const Built<Scalar> built(kr270<Scalar>(), zigzag<Scalar>({{1, 1.5}}),
                            requirements(Scalar(2e-6)));
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  TEST_ASSERT_TRUE(built.table.header().node_count > 20);
  TableCursor cursor;
  look_up<Scalar, 6>(built.table, middle_of<Scalar>(built.table, 15), &cursor);
  TEST_ASSERT_EQUAL(2 + 4, cursor.segment);
}

void a_look_up_after_a_jump_costs_no_more_than_a_few_segments() {
  jump_along_a_line<double>();
  jump_along_a_line<float>();
}

/// Anywhere between two nodes.
template <typename Scalar>
void compare_response_with_entry(const RobotModel<Scalar, 6>& model) {
  constexpr Scalar kUnits = 64 * std::numeric_limits<Scalar>::epsilon();
  const Program<Scalar> program = loop<Scalar>();
  const Built<Scalar> built(model, program, requirements(Scalar(1e-4)));
  TEST_ASSERT_EQUAL(Result::ok, built.result);
  Wrench<Scalar> wrench;
  wrench << 440, 1370, 635, 3, -8, Scalar(10.5);
  for (int place = 0; place < 30; ++place) {
    const JointVector<Scalar, 6> q = on_program(program, 7.77 * place);
    TableCursor cursor;
    locate<Scalar, 6>(built.table, q, &cursor);
    TableCursor other = cursor;
    Scalar outside = 1;
    const auto read = look_up_response<Scalar, 6>(built.table, q, wrench, &cursor, &outside);
    const auto entry = look_up<Scalar, 6>(built.table, q, &other);
    const auto expected = respond<Scalar, 6>(built.table, entry, wrench);
    TEST_ASSERT_TRUE(entry.outside == outside);
    TEST_ASSERT_TRUE((read.deflection - expected.deflection).norm() <
                     kUnits * expected.deflection.norm());
    TEST_ASSERT_TRUE((read.correction - expected.correction).norm() <
                     kUnits * expected.correction.norm());
  }
}

template <typename Scalar>
void compare_responses_with_entries() {
  compare_response_with_entry(kr270_with_everything<Scalar>());
  RobotModel<Scalar, 6> weightless = kr270_with_everything<Scalar>();
  weightless.gravity.setZero();
  compare_response_with_entry(weightless);
}

void what_a_tick_reads_is_the_response_of_the_entry() {
  compare_responses_with_entries<double>();
  compare_responses_with_entries<float>();
}

void repeated_points_do_no_harm() {
  Program<double> program = loop<double>();
  Program<double> doubled;
  for (const auto& point : program) {
    doubled.push_back(point);
    doubled.push_back(point);
  }
  const Built<double> plain(kr270<double>(), program, requirements(1e-6));
  const Built<double> repeated(kr270<double>(), doubled, requirements(1e-6));
  TEST_ASSERT_EQUAL(Result::ok, repeated.result);
  TEST_ASSERT_EQUAL(plain.size, repeated.size);
  TEST_ASSERT_EQUAL_MEMORY(plain.words.data(), repeated.words.data(), plain.size);
}

template <typename Scalar>
void leave_the_program() {
  const Built<Scalar> built(kr270<Scalar>(), loop<Scalar>(), requirements(Scalar(2e-6)));
  JointVector<Scalar, 6> q = loop_angles<Scalar>(1);
  TableCursor cursor;
  q[5] += Scalar(0.02);
  locate<Scalar, 6>(built.table, q, &cursor);
  const Scalar outside = look_up<Scalar, 6>(built.table, q, &cursor).outside;
  TEST_ASSERT_TRUE(outside > Scalar(0.01) && outside < Scalar(0.02));
}

void off_the_program_the_distance_is_told() {
  leave_the_program<double>();
  leave_the_program<float>();
}

/// An open program: before its beginning and past its end the nearest end counts.
template <typename Scalar>
void go_beyond_the_ends(const std::vector<Scalar>& distances, Scalar slack) {
  Program<Scalar> line = {loop_angles<Scalar>(0), loop_angles<Scalar>(0)};
  line[1][1] += Scalar(0.1);
  const Built<Scalar> built(kr270<Scalar>(), line, requirements(Scalar(2e-6)));
  TEST_ASSERT_EQUAL(0, built.table.header().closed);
  TableCursor cursor;
  for (const Scalar beyond : distances) {
    JointVector<Scalar, 6> q = beyond < 0 ? line[0] : line[1];
    locate<Scalar, 6>(built.table, q, &cursor);
    const auto at_end = look_up<Scalar, 6>(built.table, q, &cursor);
    q[1] += beyond;
    locate<Scalar, 6>(built.table, q, &cursor);
    const auto past_end = look_up<Scalar, 6>(built.table, q, &cursor);
    TEST_ASSERT_TRUE((at_end.jacobian - past_end.jacobian).cwiseAbs().maxCoeff() < Scalar(1e-6));
    TEST_ASSERT_TRUE(std::abs(past_end.outside - std::abs(beyond)) < slack);
  }
}

void beyond_the_ends_nothing_is_extrapolated() {
  go_beyond_the_ends<double>({-0.05, 0.05}, 1e-4);
  go_beyond_the_ends<float>({-0.05F, 0.05F}, 1e-4F);
}

/// So far that the distance along the program is no longer a number.
template <typename Scalar>
void go_as_far_as_numbers_go() {
  const Built<Scalar> built(kr270<Scalar>(), loop<Scalar>(), requirements(Scalar(2e-6)));
  for (const int sign : {-1, 1}) {
    const auto q = JointVector<Scalar, 6>::Constant(static_cast<Scalar>(sign) *
                                                    std::numeric_limits<Scalar>::max());
    for (std::uint32_t segment = 0; segment + 1 < built.table.header().node_count; ++segment) {
      TableCursor cursor;
      cursor.segment = segment;
      const auto entry = look_up<Scalar, 6>(built.table, q, &cursor);
      TEST_ASSERT_TRUE(entry.jacobian.allFinite());
      TEST_ASSERT_TRUE(entry.outside > Scalar(1e30));
    }
  }
}

void however_far_off_an_entry_of_the_table_is_read() {
  go_as_far_as_numbers_go<double>();
  go_as_far_as_numbers_go<float>();
}

void what_cannot_be_built_is_named() {
  const auto model = kr270<double>();
  const Program<double> program = loop<double>();
  std::vector<std::uint32_t> words(1 << 16);
  std::size_t size = 0;
  const auto build = [&](const RobotModel<double, 6>& robot, const Program<double>& points,
                         const TableRequirements<double>& wanted, std::size_t capacity) {
    return build_path_table<double, 6>(robot, points.data(), points.size(), wanted, words.data(),
                                       capacity, &size);
  };
  const std::size_t all = 4 * words.size();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TEST_ASSERT_EQUAL(Result::buffer_too_small, build(model, program, requirements(1e-6), 2000));
  TEST_ASSERT_EQUAL(Result::buffer_too_small, build(model, program, requirements(1e-6), 10));
  TEST_ASSERT_EQUAL(Result::tolerance_not_met, build(model, program, requirements(1e-11), all));
  TEST_ASSERT_EQUAL(Result::bad_path, build(model, {}, requirements(1e-6), all));
  TEST_ASSERT_EQUAL(Result::bad_path,
                    build(model, {program[0], program[0]}, requirements(1e-6), all));
  Program<double> broken = program;
  broken[5][3] = nan;
  TEST_ASSERT_EQUAL(Result::bad_path, build(model, broken, requirements(1e-6), all));
  RobotModel<double, 6> impossible = model;
  impossible.joints[0].compliance = -1;
  TEST_ASSERT_EQUAL(Result::bad_model, build(impossible, program, requirements(1e-6), all));
  for (const double bad : {0.0, -1.0, nan, std::numeric_limits<double>::infinity()}) {
    TEST_ASSERT_EQUAL(Result::bad_argument, build(model, program, requirements(bad), all));
  }
  TEST_ASSERT_EQUAL(Result::bad_argument, build(model, program, {-1, 0, 1e-6, 1e-6, 0}, all));
  TEST_ASSERT_EQUAL(Result::bad_argument, build(model, program, {0, 0, 1e-6, 1e-6, 0}, all));
  for (const TableRequirements<double>& bad : {TableRequirements<double>{nan, 0, 1e-6, 1e-6, 0},
                                               {10, nan, 1e-6, 1e-6, 0},
                                               {10, -1, 1e-6, 1e-6, 0},
                                               {10, 0, nan, 1e-6, 0},
                                               {10, 0, 1e-6, 0, 0},
                                               {10, 0, 1e-6, 1e-6, nan},
                                               {10, 0, 1e-6, 1e-6, -1}}) {
    TEST_ASSERT_EQUAL(Result::bad_argument, build(model, program, bad, all));
  }
  TEST_ASSERT_EQUAL(Result::tolerance_not_met, build(model, program, {10, 0, 1e-6, 1e-16, 0}, all));
  TEST_ASSERT_EQUAL(Result::buffer_too_small,
                    build(model, program, requirements(1e-6), sizeof(TableHeader) + 4));
  TEST_ASSERT_EQUAL(Result::bad_path,
                    (build_path_table<double, 6>(model, nullptr, 2, requirements(1e-6),
                                                 words.data(), all, &size)));
  TEST_ASSERT_EQUAL(Result::bad_path, build(model, {program[0]}, requirements(1e-6), all));
  TEST_ASSERT_EQUAL(Result::bad_argument,
                    (build_path_table<double, 6>(model, program.data(), program.size(),
                                                 requirements(1e-6), nullptr, all, &size)));
  TEST_ASSERT_EQUAL(Result::bad_argument,
                    (build_path_table<double, 6>(
                        model, program.data(), program.size(), requirements(1e-6),
                        reinterpret_cast<unsigned char*>(words.data()) + 1, all - 4, &size)));
}

/// Along the program either way and beside it: the cursor stands where a look-up leaves it.
void tracking_moves_the_cursor_as_a_look_up_does() {
  const auto model = kr270<double>();
  const Program<double> program = loop<double>();
  const Built<double> built(model, program, requirements(1e-6));
  TableCursor tracked;
  TableCursor looked_up;
  for (int i = 0; i < 40 * kPieces; ++i) {
    const int place = i < 20 * kPieces ? i : 40 * kPieces - i;
    JointVector<double, 6> q = on_program(program, 0.0499 * place);
    q[2] += i % 7 == 0 ? 0.01 : 0;
    const double outside = track<double, 6>(built.table, q, &tracked);
    TEST_ASSERT_TRUE(outside == (look_up<double, 6>(built.table, q, &looked_up).outside));
    TEST_ASSERT_EQUAL(looked_up.segment, tracked.segment);
    TEST_ASSERT_EQUAL(looked_up.searched, tracked.searched);
  }
}

/// A wrist singularity is no obstacle for joint springs, but base springs cannot be made up for.
void a_wrist_singularity_is_fine_for_joint_springs_alone() {
  Program<double> straight_wrist = loop<double>();
  for (auto& q : straight_wrist) {
    q[4] = 0;
  }
  const Built<double> joints(kr270<double>(), straight_wrist, requirements(1e-6));
  TEST_ASSERT_EQUAL(Result::ok, joints.result);
  auto soft_base = kr270<double>();
  soft_base.base_compliance << 0, 0, 0, 1e-6, 1e-6, 1e-6;
  const Built<double> base(soft_base, straight_wrist, requirements(1e-6));
  TEST_ASSERT_EQUAL(Result::tolerance_not_met, base.result);
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(no_place_on_the_program_exceeds_the_certificate);
  RUN_TEST(nor_with_every_kind_of_spring_and_weight);
  RUN_TEST(nor_when_the_target_itself_builds_the_table);
  RUN_TEST(the_worst_wrench_is_no_better_than_any_other);
  RUN_TEST(following_the_program_either_way_keeps_the_certificate);
  RUN_TEST(a_finer_tolerance_costs_about_the_square_root_in_nodes);
  RUN_TEST(corners_of_every_angle_keep_the_certificate);
  RUN_TEST(a_program_that_runs_back_on_itself_is_followed);
  RUN_TEST(a_program_that_turns_off_backwards_is_found_again);
  RUN_TEST(a_program_that_comes_back_beside_itself_keeps_the_certificate);
  RUN_TEST(a_place_that_was_located_is_looked_up_there);
  RUN_TEST(after_a_jump_any_segment_is_found_from_any_other);
  RUN_TEST(a_look_up_after_a_jump_costs_no_more_than_a_few_segments);
  RUN_TEST(what_a_tick_reads_is_the_response_of_the_entry);
  RUN_TEST(tracking_moves_the_cursor_as_a_look_up_does);
  RUN_TEST(repeated_points_do_no_harm);
  RUN_TEST(off_the_program_the_distance_is_told);
  RUN_TEST(beyond_the_ends_nothing_is_extrapolated);
  RUN_TEST(however_far_off_an_entry_of_the_table_is_read);
  RUN_TEST(what_cannot_be_built_is_named);
  RUN_TEST(a_wrist_singularity_is_fine_for_joint_springs_alone);
  return UNITY_END();
}
