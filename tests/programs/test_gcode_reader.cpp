// Facts of RS274/NGC (NISTIR 6556, section 3) and of what CAM systems and simulators make of it.
#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <string>

#include "cases.hpp"
#include "programs/gcode_reader.hpp"
#include "programs/positions.hpp"
#include "refusal.hpp"
#include "unity_main.hpp"

using flexcomp::Pose;
using flexcomp::Vector3;
using flexcomp::programs::gcode_program;
using flexcomp::programs::Motion;
using flexcomp::programs::MotionKind;
using flexcomp::programs::pose_at;
using flexcomp::programs::Program;
using flexcomp::test::assert_at;
using flexcomp::test::refusal_of;

namespace {

Program program_of(const std::string& text) { return gcode_program("p.nc", text); }

std::string refusal(const std::string& text) {
  return refusal_of([&] { program_of(text); });
}

Vector3<double> middle_of(const Program& program, std::size_t motion, double share = 0.5) {
  return pose_at(program.motions[motion - 1].end, program.motions[motion], share).position;
}

void modal_words_last_and_axes_that_are_left_out_stay() {
  const Program program = program_of(
      "%\nN10 G21 G90 G17 (millimetres)\ng0 x10 y-5 z 20\nG1 Z-1.5 F600 ; down\nX+30\nG91 X5 Y.5\n"
      "G20 X1.\nM30\nG1 X99\n");
  TEST_ASSERT_EQUAL(5, program.motions.size());
  assert_at(10, -5, 20, program.motions[0].end.position);
  TEST_ASSERT_TRUE(program.motions[0].kind == MotionKind::rapid);
  assert_at(10, -5, -1.5, program.motions[1].end.position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.010, program.motions[1].feed);
  TEST_ASSERT_EQUAL(4, program.motions[1].line);
  assert_at(30, -5, -1.5, program.motions[2].end.position);
  assert_at(35, -4.5, -1.5, program.motions[3].end.position);
  assert_at(60.4, -4.5, -1.5, program.motions[4].end.position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 600 * 0.0254 / 60, program.motions[4].feed);
}

void arcs_by_their_middle_go_the_way_they_are_told() {
  const Program ccw = program_of("G0 X10 Y0 Z0\nG3 X0 Y10 I-10 J0 F60\n");
  assert_at(10 * std::sqrt(0.5), 10 * std::sqrt(0.5), 0, middle_of(ccw, 1));
  const Program cw = program_of("G0 X10 Y0 Z0\nG2 X0 Y10 I-10 J0 F60\n");  // three quarters round
  assert_at(-10 * std::sqrt(0.5), -10 * std::sqrt(0.5), 0, middle_of(cw, 1));
  const Program full = program_of("G0 X10 Y0 Z0\nG3 I-10 F60\n");
  assert_at(-10, 0, 0, middle_of(full, 1));
  const Program absolute = program_of("G90.1\nG0 X10 Y5 Z0\nG3 X5 Y10 I5 J5 F60\n");
  assert_at(5 + 5 * std::sqrt(0.5), 5 + 5 * std::sqrt(0.5), 0, middle_of(absolute, 1));
}

/// In G18 an arc runs from z to x: clockwise seen from +y.
void planes_turn_by_their_own_right_hand() {
  const Program xz = program_of("G18\nG0 X0 Y0 Z10\nG3 X10 Z0 I0 K-10 F60\n");
  assert_at(10 * std::sqrt(0.5), 0, 10 * std::sqrt(0.5), middle_of(xz, 1));
  const Program yz = program_of("G19\nG0 X0 Y10 Z0\nG3 Y0 Z10 J-10 K0 F60\n");
  assert_at(0, 10 * std::sqrt(0.5), 10 * std::sqrt(0.5), middle_of(yz, 1));
}

void the_sign_of_r_chooses_the_shorter_or_the_longer_arc() {
  const Program shorter = program_of("G0 X0 Y0 Z0\nG2 X10 Y10 R10 F60\n");  // about (10, 0)
  assert_at(10 - 10 * std::sqrt(0.5), 10 * std::sqrt(0.5), 0, middle_of(shorter, 1));
  const Program longer = program_of("G0 X0 Y0 Z0\nG2 X10 Y10 R-10 F60\n");  // about (0, 10)
  assert_at(-10 * std::sqrt(0.5), 10 + 10 * std::sqrt(0.5), 0, middle_of(longer, 1));
  const Program half = program_of("G0 X0 Y0 Z0\nG3 X20 Y0 R10 F60\n");
  assert_at(10, -10, 0, middle_of(half, 1));
}

void a_helix_rises_evenly_and_p_adds_turns() {
  const Program program = program_of("G0 X10 Y0 Z0\nG3 X10 Y0 Z-8 I-10 P2 F60\n");
  assert_at(10, 0, -4, middle_of(program, 1));
  assert_at(-10, 0, -2, middle_of(program, 1, 0.25));
  const double length = flexcomp::programs::length_of(program.motions[0].end, program.motions[1]);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, std::hypot(0.04 * M_PI, 0.008), length);
}

/// An end that is written to three digits is met, and no point is off the circle by more than that.
void arcs_are_exact_within_what_their_end_is_rounded_to() {
  const Program program = program_of("G0 X60 Y0 Z0\nG3 X-51.962 Y30 I-60 J0 F60\n");  // 150°
  assert_at(-51.962, 30, 0, program.motions[1].end.position);
  for (double share = 0; share < 1; share += 0.01) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-6, 0.060, middle_of(program, 1, share).norm());
  }
}

void angles_turn_the_tool_about_the_frames_axes() {
  const Program down = program_of("G0 X0 Y0 Z0\n");
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, -1, down.motions[0].end.rotation(2, 2));
  const Program tilted = program_of("G1 X0 Y0 Z0 B30 C90 F1\n");
  // Leaning by 30° towards x, then turned by 90° about z: towards y.
  const Vector3<double> spindle = -tilted.motions[0].end.rotation.col(2);
  TEST_ASSERT_DOUBLE_WITHIN(
      1e-12, 0, (spindle - Vector3<double>(0, std::sin(M_PI / 6), std::cos(M_PI / 6))).norm());
}

void only_what_is_fed_with_a_turning_spindle_cuts() {
  const Program program = program_of("G0 X0 Y0 Z0\nG1 X1 F60\nM3 S8000\nG1 X2\nG0 X3\nM5\nG1 X4\n");
  const bool expected[] = {false, false, true, false, false};
  for (std::size_t i = 0; i < 5; ++i) {
    TEST_ASSERT_EQUAL(expected[i], program.motions[i].is_cutting);
  }
  TEST_ASSERT_TRUE(program_of("G0 X0 Y0 Z0\nG1 X1 F60\n").motions[1].is_cutting);
}

void inverse_time_feeds_take_their_share_of_a_minute() {
  const Program program = program_of("G0 X0 Y0 Z0\nG93 G1 X60 F4\n");  // a quarter of a minute
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.060 / 15, program.motions[1].feed);
}

void every_unknown_word_is_told_with_its_line() {
  const std::string refusals[][2] = {
      {"G0 X1\nG5.1 Q1\n", "p.nc:2: 'G5.1': unknown word"},
      {"G0 X1\nM98 P100\n", "p.nc:2: 'M98': unknown word"},
      {"U3\n", "p.nc:1: 'U3': unknown word"},
      {"\n\nG81 X1 Z-3 R2 F60\n", "p.nc:3: 'G81': unknown word"},
      {"G41 D1\n", "p.nc:1: 'G41': cutter compensation"},
      {"G54\nG0 X1\nG55\n", "p.nc:3: 'G55': a second work offset"},
      {"#1=5\n", "p.nc:1: '#1=5' begins no word"},
      {"G0 X[1+2]\n", "p.nc:1: 'X[1+2]': expected a number after X"},
      {"G0 X1 (open\n", "p.nc:1: a comment without its closing bracket"},
      {"G1 X1 Y1 Z1\n", "p.nc:1: the feed is missing"},
      {"X1\n", "p.nc:1: axes without a motion"},
      {"G80 X1\n", "p.nc:1: axes without a motion"},
      {"G0 G1 X1 F1\n", "p.nc:1: 'G1': a second motion"},
      {"G0 X1 X2\n", "p.nc:1: a letter stands twice"},
      {"G0 X1 R2\n", "p.nc:1: I, J, K and R go with G2 and G3"},
      {"G0 X0 Y0 Z0\nG2 X1 F1\n", "p.nc:2: an arc without its middle"},
      {"G0 X0 Y0 Z0\nG2 X10 I4 F1\n",
       "p.nc:2: start and end of the arc are not equally far from its middle"},
      {"G0 X0 Y0 Z0\nG2 X10 R4 F1\n", "p.nc:2: R is too small"},
      {"G0 X0 Y0 Z0\nG2 X0 R4 F1\n", "p.nc:2: an arc by R needs an end other than its start"},
      {"G0 X0 Y0 Z0\nG2 X10 K4 F1\n", "p.nc:2: the middle of an arc lies in its plane"},
      {"G1 X1 F0\n", "p.nc:1: 'F0': a feed must be above zero"},
      {"G0 X1e400\n", "p.nc:1: 'E400': unknown word"},
      {"G0 X999999999 Y0 Z0\n", "p.nc:1: no machine reaches so far"},
      {"G0 Xnan\n", "p.nc:1: 'Xnan'"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told = refusal(text);
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
}

void a_million_lines_are_read_in_seconds() {
  constexpr int kLines = flexcomp::test::cases(1000000);
  std::string text = "G0 X0 Y0 Z0\nF1000\n";
  for (int i = 0; i < kLines; ++i) {
    text += "N" + std::to_string(i % 10000) + " G1 X" + std::to_string(i % 977) + ".125 Y-" +
            std::to_string(i % 331) + ".5 Z0.75\n";
  }
  const auto begun = std::chrono::steady_clock::now();
  TEST_ASSERT_EQUAL(kLines + 1, program_of(text).motions.size());
  TEST_ASSERT_TRUE(std::chrono::steady_clock::now() - begun < std::chrono::seconds(10));
}

void places_of_the_machine_are_noted_and_left_out() {
  const Program program = program_of("G0 X1 Y2 Z3\nG91 G28 Z0\nG90 G0 Z5\n");
  TEST_ASSERT_EQUAL(2, program.motions.size());
  TEST_ASSERT_EQUAL(2, program.notes.size());
  TEST_ASSERT_EQUAL(2, program.notes[0].line);
  TEST_ASSERT_EQUAL_STRING(
      "Z is not known: line 2 goes to a place of the machine; the way here from line 1 is planned "
      "as straight",
      program.notes[1].text.c_str());
}

/// How Fusion 360 begins: Z is told with the tool's length alone, in line 5.
void rapids_before_all_axes_are_told_are_no_part_of_the_path() {
  const Program program =
      program_of("G28 G91 Z0.\nG90\nG54\nG0 X100. Y0.\nG43 Z80. H1\nZ55.\nG1 Z49. F300.\n");
  TEST_ASSERT_EQUAL(3, program.motions.size());
  TEST_ASSERT_EQUAL(5, program.motions[0].line);
  TEST_ASSERT_FALSE(program.motions[0].has_known_start);
  TEST_ASSERT_TRUE(program.motions[1].has_known_start);
  assert_at(100, 0, 80, program.motions[0].end.position);
  TEST_ASSERT_EQUAL_STRING("Z is not known: line 1 goes to a place of the machine; left as it is",
                           program.notes[1].text.c_str());
}

/// What is told in differences stays unknown, and another tool's tip is elsewhere.
void axes_are_unknown_until_they_are_told_again() {
  const std::string known = "G0 X0 Y0 Z10 A0\n";
  TEST_ASSERT_EQUAL(1, program_of(known + "G28 G91 Z0\nG0 Z-5\n").motions.size());
  TEST_ASSERT_EQUAL(1, program_of(known + "T2 M6\nG0 X5 Y5\n").motions.size());
  TEST_ASSERT_EQUAL(2, program_of(known + "T2 M6\nG0 X5 Y5\nG43 Z9 H2\n").motions.size());
  TEST_ASSERT_EQUAL(1, program_of(known + "G30 A0\nG0 X5\n").motions.size());
  TEST_ASSERT_EQUAL(2, program_of(known + "G53 G0 A0\nG0 X5 A1\n").motions.size());
  TEST_ASSERT_EQUAL(1, program_of(known + "G28\nG0 X5 Y5 Z5\n").motions.size());
  TEST_ASSERT_EQUAL(2, program_of("G28\nG0 X5 Y5 Z5\nG0 X9\n").motions.size());
}

void cuts_from_or_to_an_unknown_place_are_refused() {
  const std::string refusals[][2] = {
      {"G0 X0 Y0 Z10\nG53 G0 Z0\nG1 X10 F600\n",
       "p.nc:3: Z is not known: line 2 goes to a place of the machine; a motion at a feed begins"},
      {"G0 X0 Y0 Z10\nG28 G91 Z0\nG90 G1 X0 Y0 Z-1 F600\n", "p.nc:3: Z is not known: line 2"},
      {"G0 X0 Y0 Z10\nT1 M6\nG1 Z-1 F600\n", "p.nc:3: X is not known: line 2 changes the tool"},
      {"G0 X0 Y0\nG1 Z-1 F600\n", "p.nc:2: Z is not known: no line before tells it"},
      {"G1 X0 Z5 F600\n", "p.nc:1: X is not known: no line before tells it"},
      {"G91 G1 X0 Y0 Z5 F600\n", "p.nc:1: X is not known: no line before tells it"},
      {"G2 X1 Y1 Z1 R5 F60\n", "p.nc:1: X is not known: no line before tells it"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told = refusal(text);
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
  TEST_ASSERT_EQUAL(2, program_of("G1 X0 Y0 Z5 F600\nZ4\n").motions.size());
}

/// Degrees a minute where A, B and C move alone, as if they were at right angles; the rotation of
/// 30° about x and 40° about y at once is 49.5°, what the words say is 50°.
void feeds_of_turns_are_those_of_the_standard() {
  const std::string at = "G0 X0 Y0 Z0 A0 B0\n";
  const Program both = program_of(at + "G1 X10 A30 F600\n");
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.010, both.motions[1].feed);
  TEST_ASSERT_EQUAL_DOUBLE(0, both.motions[1].turn_feed);
  const Program alone = program_of(at + "G1 A30 F600\n");
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 10 * M_PI / 180, alone.motions[1].turn_feed);
  const Program two = program_of(at + "G1 A30 B40 F600\n");
  const double angle = 2 * std::acos(std::cos(M_PI / 12) * std::cos(M_PI / 9));
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, angle / 5, two.motions[1].turn_feed);
  const Program inverse = program_of(at + "G93 G1 A30 F2\n");
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1 * M_PI / 180, inverse.motions[1].turn_feed);
  TEST_ASSERT_EQUAL_DOUBLE(0, inverse.motions[1].feed);
}

void a_feed_does_not_outlast_its_mode() {
  TEST_ASSERT_EQUAL_STRING("p.nc:3: the feed is missing: expected F",
                           refusal("G0 X0 Y0 Z0\nG93 G1 X10 F2\nG94 X20\n").c_str());
}

void a_program_ends_at_its_second_percent_sign() {
  const std::string program = "G21 G90\nG0 X0 Y0 Z10\n";
  const Program two = program_of("\n(a)\n%\n" + program + " %\nG1 X20 F60\n(b) G5\n");
  TEST_ASSERT_EQUAL(1, two.motions.size());
  TEST_ASSERT_EQUAL(1, two.notes.size());
  TEST_ASSERT_EQUAL(6, two.notes[0].line);
  TEST_ASSERT_EQUAL(0, program_of("%\n" + program + "%\n\n").notes.size());
  TEST_ASSERT_EQUAL(1, program_of(program + "%\nG0 X1\n").motions.size());
}

void block_delete_is_noted_once() {
  const Program program = program_of("G0 X0 Y0 Z10\n/M1\n/G0 X5\n /N9 X6\n");
  TEST_ASSERT_EQUAL(3, program.motions.size());
  TEST_ASSERT_EQUAL(1, program.notes.size());
  TEST_ASSERT_EQUAL(3, program.notes[0].line);
}

void a_dwell_is_noted_and_moves_nothing() {
  const Program program = program_of("G0 X0 Y0 Z10\nG4 P2\n");
  TEST_ASSERT_EQUAL(1, program.motions.size());
  TEST_ASSERT_EQUAL(2, program.notes[0].line);
  TEST_ASSERT_EQUAL_STRING("p.nc:2: a dwell with an axis; expected G4 and P",
                           refusal("G0 X0 Y0 Z10\nG4 X2\n").c_str());
}

/// Siemens' G4 F3 waits three seconds; in RS274/NGC the F would be the feed of all that follows.
void a_dwell_in_siemens_words_is_no_feed() {
  TEST_ASSERT_EQUAL_STRING(
      "p.nc:3: 'F' beside G4: a dwell in seconds (Siemens) or a feed? expected G4 and P",
      refusal("G0 X0 Y0 Z0\nG1 X10 F600\nG4 F3\nG1 X110\n").c_str());
  const Program program = program_of("G0 X0 Y0 Z0\nG4 P3 F600\nG1 X110\n");
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.01, program.motions[1].feed);
}

void p_of_g30_is_the_number_of_the_place() {
  const Program program = program_of("G91 G30 P2 Z0\nG90 G0 X0 Y0 Z5\n");
  TEST_ASSERT_EQUAL(1, program.motions.size());
  TEST_ASSERT_EQUAL_STRING("p.nc:1: 'P': goes with G4, G30, G64 and arcs alone",
                           refusal("G91 G28 P2 Z0\n").c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(modal_words_last_and_axes_that_are_left_out_stay);
  RUN_TEST(arcs_by_their_middle_go_the_way_they_are_told);
  RUN_TEST(planes_turn_by_their_own_right_hand);
  RUN_TEST(the_sign_of_r_chooses_the_shorter_or_the_longer_arc);
  RUN_TEST(a_helix_rises_evenly_and_p_adds_turns);
  RUN_TEST(arcs_are_exact_within_what_their_end_is_rounded_to);
  RUN_TEST(angles_turn_the_tool_about_the_frames_axes);
  RUN_TEST(only_what_is_fed_with_a_turning_spindle_cuts);
  RUN_TEST(inverse_time_feeds_take_their_share_of_a_minute);
  RUN_TEST(every_unknown_word_is_told_with_its_line);
  RUN_TEST(a_million_lines_are_read_in_seconds);
  RUN_TEST(places_of_the_machine_are_noted_and_left_out);
  RUN_TEST(rapids_before_all_axes_are_told_are_no_part_of_the_path);
  RUN_TEST(axes_are_unknown_until_they_are_told_again);
  RUN_TEST(cuts_from_or_to_an_unknown_place_are_refused);
  RUN_TEST(feeds_of_turns_are_those_of_the_standard);
  RUN_TEST(a_feed_does_not_outlast_its_mode);
  RUN_TEST(a_program_ends_at_its_second_percent_sign);
  RUN_TEST(block_delete_is_noted_once);
  RUN_TEST(a_dwell_is_noted_and_moves_nothing);
  RUN_TEST(a_dwell_in_siemens_words_is_no_feed);
  RUN_TEST(p_of_g30_is_the_number_of_the_place);
  return UNITY_END();
}
