// What a controller does with the lines that the writer leaves beside those that it writes.
#include <string>

#include "programs/corrected_program.hpp"
#include "programs/gcode_reader.hpp"
#include "unity_main.hpp"

using flexcomp::Pose;
using flexcomp::programs::CorrectedProgram;
using flexcomp::programs::Format;
using flexcomp::programs::gcode_program;
using flexcomp::programs::Motion;
using flexcomp::programs::MotionKind;
using flexcomp::programs::text_of;

namespace {

/// Every point corrected by 0.1 mm along x; motions at a feed in two lines of equal length, where
/// `halves` says so.
CorrectedProgram corrected(const std::string& text, bool halves = false) {
  CorrectedProgram program;
  program.source = gcode_program("p.nc", text);
  program.largest_correction = 1e-4;
  Pose<double> before = program.source.motions.front().end;
  for (Motion motion : program.source.motions) {
    std::vector<Motion> place;
    if (halves && motion.kind == MotionKind::linear) {
      Motion half = motion;
      half.end = flexcomp::programs::pose_at(before, motion, 0.5);
      place.push_back(half);
    }
    before = motion.end;
    place.push_back(motion);
    for (Motion& each : place) {
      each.end.position.x() += 1e-4;
    }
    program.in_place.push_back(place);
  }
  return program;
}

std::string rewritten(const std::string& text, bool halves = false) {
  return text_of(corrected(text, halves), Format::gcode, "p");
}

void axes_that_nothing_has_told_stay_unwritten() {
  TEST_ASSERT_EQUAL_STRING(
      "N2 G28 G91 Z0.\nN3 G90\nN7 G0 X100. Y0.\n"
      "N8 G90 G0 X100.1000 Y0.0000 Z80.0000 G43 H1\n"
      "N10 G90 G1 X100.1000 Y0.0000 Z49.0000 F300.\n"
      "G28 G91 Z0.\nG90\nT2 M06\nG0 X120. Y80.\nG90 G0 X120.1000 Y80.0000 Z50.0000 G43 H02\n",
      rewritten("N2 G28 G91 Z0.\nN3 G90\nN7 G0 X100. Y0.\nN8 G43 Z80. H1\nN10 G1 Z49. F300.\n"
                "G28 G91 Z0.\nG90\nT2 M06\nG0 X120. Y80.\nG43 Z50. H02\n")
          .c_str());
}

void lines_that_stay_as_they_are_have_their_own_mode() {
  TEST_ASSERT_EQUAL_STRING(
      "G90 G0 X0.1000 Y0.0000 Z10.0000\nG91\nG90 G1 X0.1000 Y0.0000 Z-1.0000 F600\n"
      "G90 G0 X0.1000 Y0.0000 Z10.0000\r\nG91\r\nG28 Z0\nM30\n",
      rewritten("G0 X0 Y0 Z10\nG91\nG1 Z-11 F600\nG0 Z11\r\nG28 Z0\nM30\n").c_str());
}

void words_beside_the_motion_stay() {
  TEST_ASSERT_EQUAL_STRING(
      "G90 G0 X0.1000 Y0.0000 Z10.0000 A0.000000 S1000 M3\n"
      "G90 G1 X1.1000 Y0.0000 Z10.0000 A0.000000 G64 P0.1 F600 (in)\n",
      rewritten("G0 X0 Y0 Z10 A0 S1000 M3\nG64 P0.1 G1 X1 F600 (in)\n").c_str());
}

void what_acts_behind_a_motion_stands_in_its_last_line() {
  TEST_ASSERT_EQUAL_STRING(
      "G90 G0 X0.1000 Y0.0000 Z10.0000\nG90 G1 X5.1000 Y0.0000 Z10.0000 F60 M8\n"
      "G1 X10.1000 Y0.0000 Z10.0000 M0\n",
      rewritten("G0 X0 Y0 Z10\nG1 X10 F60 M0 M8\n", true).c_str());
}

void lines_of_a_skippable_line_can_be_skipped() {
  TEST_ASSERT_EQUAL_STRING(
      "G90 G0 X0.1000 Y0.0000 Z10.0000\n/N4 G90 G1 X5.1000 Y0.0000 Z10.0000 F300\n"
      "/G1 X10.1000 Y0.0000 Z10.0000\n/G90 G1 X15.1000 Y0.0000 Z10.0000\n"
      "/G1 X20.1000 Y0.0000 Z10.0000\n",
      rewritten("G0 X0 Y0 Z10\n/N4 G1 X10 F300\n/X20\n", true).c_str());
}

/// Half the way takes half the time: F is one over minutes.
void inverse_times_are_shared_by_the_lines_of_a_motion() {
  TEST_ASSERT_EQUAL_STRING(
      "G90 G0 X0.1000 Y0.0000 Z10.0000\nG93\nG90 G93 G1 X5.1000 Y0.0000 Z10.0000 F4\n"
      "G1 X10.1000 Y0.0000 Z10.0000 F4\nG94\nG90 G1 X15.1000 Y0.0000 Z10.0000 F600\n"
      "G1 X20.1000 Y0.0000 Z10.0000\n",
      rewritten("G0 X0 Y0 Z10\nG93\nG1 X10 F2\nG94\nX20 F600\n", true).c_str());
}

/// 10° at 600 degrees a minute take a second, 1/60 of a minute, however little the tip moves.
void a_corrected_turn_keeps_its_time() {
  TEST_ASSERT_EQUAL_STRING(
      "G90 G0 X0.1000 Y0.0000 Z10.0000 A0.000000 B0.000000 C0.000000\n"
      "G90 G93 G1 X0.1000 Y0.0000 Z10.0000 A10.000000 B0.000000 C0.000000 F60 M8\nG94 F600\n",
      rewritten("G0 X0 Y0 Z10 A0\nG1 A10 F600 M8\n").c_str());
}

void other_formats_say_in_comments_what_a_moving_line_says_beside() {
  const CorrectedProgram program = corrected("G0 X0 Y0 Z5 M3 S9000\nN3 G1 X10 F600 (last)\n");
  const std::string krl = text_of(program, Format::krl, "p");
  TEST_ASSERT_TRUE(krl.find("\n; M3 S9000\nPTP {X 0.1000") != std::string::npos);
  TEST_ASSERT_TRUE(krl.find("\n; (last)\n") != std::string::npos);
  TEST_ASSERT_TRUE(text_of(program, Format::rapid, "p").find("\n  ! M3 S9000\n") !=
                   std::string::npos);
}

/// Straight from one point to the next would be through the work.
void other_formats_stop_where_the_way_is_not_told() {
  const CorrectedProgram program =
      corrected("G0 X0 Y0 Z5\nG1 Z-1 F60\nG28 G91 Z0\nG90\nG0 X80 Y0\nZ40\n");
  const std::string krl = text_of(program, Format::krl, "p");
  const std::string halt =
      "\n; G0 X80 Y0\nHALT ; the source does not tell the way to the next point: come to it by a "
      "motion of your own\nPTP {X 80.1000,Y 0.0000,Z 40.0000";
  TEST_ASSERT_TRUE(krl.find(halt) != std::string::npos);
  TEST_ASSERT_EQUAL(krl.find("HALT"), krl.rfind("HALT"));
  const std::string rapid = text_of(program, Format::rapid, "p");
  TEST_ASSERT_TRUE(
      rapid.find("\n  Stop; ! the source does not tell the way to the next point: come "
                 "to it by a motion of your own\n  MoveJ [[80.1000,0.0000,40.0000]") !=
      std::string::npos);
}

/// 30° in half a minute are a degree a second; the motion behind it has the machine's own limit.
void other_formats_turn_as_slowly() {
  const CorrectedProgram program = corrected("G0 X0 Y0 Z5 A0\nG93 G1 A30 F2\nG94 X10 F600\n");
  const std::string krl = text_of(program, Format::krl, "p");
  TEST_ASSERT_TRUE(krl.find("\n$VEL.ORI1=1\n$VEL.ORI2=1\nLIN ") != std::string::npos);
  TEST_ASSERT_TRUE(
      krl.find("\n$VEL.ORI1=$VEL_MA.ORI1\n$VEL.ORI2=$VEL_MA.ORI2\n$VEL.CP=0.01\nLIN ") !=
      std::string::npos);
  const std::string rapid = text_of(program, Format::rapid, "p");
  TEST_ASSERT_TRUE(rapid.find(",[50,1,5000,1000],") != std::string::npos);
  TEST_ASSERT_TRUE(rapid.find(",[10,500,5000,1000],") != std::string::npos);
}

/// A table that is at C170 would go back by 340 degrees to C-170.
void rotary_axes_keep_their_turns() {
  TEST_ASSERT_EQUAL_STRING(
      "G90 G0 X0.1000 Y0.0000 Z0.0000 A10.000000 B0.000000 C170.000000\n"
      "G90 G1 X10.1000 Y0.0000 Z0.0000 A10.000000 B0.000000 C190.000000 F600\n"
      "G90 G1 X20.1000 Y0.0000 Z0.0000 A10.000000 B0.000000 C740.000000\nG91\n"
      "G90 G1 X30.1000 Y0.0000 Z0.0000 A10.000000 B100.000000 C730.000000\n",
      rewritten("G0 X0 Y0 Z0 A10 C170\nG1 X10 C190 F600\nX20 C740\nG91\nX10 B100 C-10\n").c_str());
}

void rotary_axes_of_a_new_program_go_the_short_way() {
  CorrectedProgram program = corrected("G0 X0 Y0 Z0 A10 C170\nG1 X10 C190 F600\nX20 C350\nC370\n");
  program.source.format = Format::rapid;
  const std::string text = text_of(program, Format::gcode, "p");
  std::size_t at = 0;
  for (const char* each : {" C170.000000", " C190.000000", " C350.000000", " C370.000000"}) {
    at = text.find(each, at);
    TEST_ASSERT_TRUE(at != std::string::npos);
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(axes_that_nothing_has_told_stay_unwritten);
  RUN_TEST(lines_that_stay_as_they_are_have_their_own_mode);
  RUN_TEST(words_beside_the_motion_stay);
  RUN_TEST(what_acts_behind_a_motion_stands_in_its_last_line);
  RUN_TEST(lines_of_a_skippable_line_can_be_skipped);
  RUN_TEST(inverse_times_are_shared_by_the_lines_of_a_motion);
  RUN_TEST(a_corrected_turn_keeps_its_time);
  RUN_TEST(other_formats_say_in_comments_what_a_moving_line_says_beside);
  RUN_TEST(other_formats_stop_where_the_way_is_not_told);
  RUN_TEST(other_formats_turn_as_slowly);
  RUN_TEST(rotary_axes_keep_their_turns);
  RUN_TEST(rotary_axes_of_a_new_program_go_the_short_way);
  return UNITY_END();
}
