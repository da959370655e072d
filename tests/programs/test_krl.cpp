// KRL as KUKA's programming manuals and programs that others published have it: inline forms with
// their folds, points in a .dat, CIRC with CA, targets that say only what changes.
#include <Eigen/Geometry>
#include <chrono>
#include <cmath>
#include <string>

#include "cases.hpp"
#include "programs/corrected_program.hpp"
#include "programs/krl_point.hpp"
#include "programs/krl_reader.hpp"
#include "programs/positions.hpp"
#include "refusal.hpp"
#include "unity_main.hpp"

using flexcomp::Matrix3;
using flexcomp::Pose;
using flexcomp::Vector3;
using flexcomp::test::assert_at;
using flexcomp::test::refusal_of;
using namespace flexcomp::programs;

namespace {

std::string refusal(const std::string& src) {
  return refusal_of([&] { krl_program("p.src", src, ""); });
}

constexpr const char* kInlineForms =
    "&ACCESS RVP\n&REL 3\nDEF part( )\n;FOLD INI\n  BAS (#INITMOV,0 )\n;ENDFOLD (INI)\n"
    "FOR I=1 TO 6\n$VEL_AXIS[I]=25\nENDFOR\n"
    "$BASE={X 1000,Y -200,Z 500,A 90,B 0,C 0}\n"
    ";FOLD PTP HOME Vel= 100 % DEFAULT;%{PE}%MKUKATPBASIS\nPTP  XHOME\n;ENDFOLD\n"
    ";FOLD PTP P1 CONT Vel=100 % PDAT1 Tool[1] Base[1];%{PE}\nPTP XP1 C_PTP\n;ENDFOLD\n"
    "BAS(#CP_PARAMS,0.2)\nLIN XP2 C_DIS ; along the edge\n"
    "$VEL.CP=0.05\nCIRC {X 150,Y 50},{X 100,Y 100}\nLIN_REL {X -10}\n$OUT[3]=TRUE\nEND\n";
constexpr const char* kData =
    "DEFDAT part\nDECL E6POS XP1={X 100.0,Y 0.0,Z 20.0,A 0.0,B 90.0,C 0.0,S 2,T 35,E1 0.0}\n"
    "E6POS XP2={E6POS: X 100.0,Y 0.0,Z 0,A 0,B 90,C 0,S 2,T 35,E1 0.0,E2 0.0}\nENDDAT\n";

void inline_forms_move_to_the_points_of_the_data_list() {
  const Program program = krl_program("part.src", kInlineForms, kData);
  TEST_ASSERT_EQUAL(4, program.motions.size());
  assert_at(100, 0, 20, program.motions[0].end.position);
  TEST_ASSERT_TRUE(program.motions[0].kind == MotionKind::rapid);
  TEST_ASSERT_EQUAL(15, program.motions[0].line);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.2, program.motions[1].feed);
  assert_at(100, 100, 0, program.motions[2].end.position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.05, program.motions[2].feed);
  const Vector3<double> half = pose_at(program.motions[1].end, program.motions[2], 0.5).position;
  assert_at(150, 50, 0, half);
  assert_at(90, 100, 0, program.motions[3].end.position);
  assert_at(1000, -200, 500, program.frame->position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, program.frame->rotation(1, 0));
}

/// B = 90° puts the tool's z axis along x, whatever else.
void angles_turn_about_z_then_y_then_x() {
  const Program program = krl_program(
      "p.src", "DEF p()\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\nPTP {A 90}\nPTP {A 0,B 0,C 90}\nEND\n",
      "");
  const auto tool_axis = [&](std::size_t i) {
    return Vector3<double>(program.motions[i].end.rotation.col(2));
  };
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (tool_axis(0) - Vector3<double>::UnitX()).norm());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (tool_axis(1) - Vector3<double>::UnitY()).norm());
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (tool_axis(2) + Vector3<double>::UnitY()).norm());
}

void angles_are_those_of_the_orientation() {
  const double degree = M_PI / 180;
  for (const double b : {-90.0, -40.0, 0.0, 75.0, 90.0}) {
    const KrlPoint point{{0, 0, 0, 30, b, -70}, false};
    const Matrix3<double> rotation = point.pose().rotation;
    const auto angles = krl_angles(rotation);
    const Matrix3<double> again = (Eigen::AngleAxisd(angles[0] * degree, Vector3<double>::UnitZ()) *
                                   Eigen::AngleAxisd(angles[1] * degree, Vector3<double>::UnitY()) *
                                   Eigen::AngleAxisd(angles[2] * degree, Vector3<double>::UnitX()))
                                      .toRotationMatrix();
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, 0, (again - rotation).norm());
  }
}

void ca_goes_round_as_far_as_it_says() {
  const std::string start =
      "DEF p()\nPTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\nCIRC {X 0,Y 10},{X -10,Y 0},CA ";
  const Program forwards = krl_program("p.src", start + "270\nEND\n", "");
  assert_at(0, -10, 0, forwards.motions[1].end.position);
  const Program backwards = krl_program("p.src", start + "-90\nEND\n", "");
  assert_at(0, -10, 0, backwards.motions[1].end.position);
  assert_at(10 * std::sqrt(0.5), -10 * std::sqrt(0.5), 0,
            pose_at(backwards.motions[0].end, backwards.motions[1], 0.5).position);
}

void what_cannot_be_told_is_refused_with_its_line() {
  const std::string start = "DEF p()\nPTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\n";
  const std::string refusals[][2] = {
      {"IF $IN[1] THEN\nLIN {X 1}\nENDIF\n", "p.src:4: a motion in a branch or a loop"},
      {"LIN XP7\n", "p.src:3: 'XP7': no file tells this point"},
      {"LIN {X one}\n", "p.src:3: expected a point such as"},
      {"LIN {X 1,Y 2\n", "p.src:3: expected a point such as"},
      {"SPLINE\n", "p.src:3: 'SPLINE': this motion is not read"},
      {"CIRC {X 20},{X 30}\n", "p.src:3: start, point between and end of the circle lie on a line"},
      {"CIRC {X 20}\n", "p.src:3: expected a comma and the circle's end"},
      {"LIN XP1:OFFSET\n", "p.src:3: 'XP1': a point that is computed"},
      {"END\nDEF q()\nLIN {X 1}\n", "p.src:5: a motion in a second routine"},
      {"$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}\nLIN {X 1}\n$BASE={X 2,Y 0,Z 0,A 0,B 0,C 0}\n",
       "p.src:5: a second $BASE"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told = refusal(start + text);
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
  TEST_ASSERT_EQUAL_STRING(
      "p.src:2: the point lacks some of X, Y, Z, A, B and C, and no point "
      "before it tells them",
      refusal("DEF p()\nLIN {X 1}\n").c_str());
}

void unknown_words_are_noted_with_their_line() {
  const Program program =
      krl_program("p.src", "DEF p()\nGrpOpen()\n$TOOL=TOOL_DATA[1]\nPTP {A1 0,A2 -90}\nEND\n", "");
  TEST_ASSERT_EQUAL(3, program.notes.size());
  TEST_ASSERT_EQUAL(2, program.notes[0].line);
  TEST_ASSERT_EQUAL_STRING("'GRPOPEN' is unknown; if it moves the robot, its way is missing",
                           program.notes[0].text.c_str());
  TEST_ASSERT_EQUAL(4, program.notes[2].line);
}

void a_million_lines_are_read_in_seconds() {
  constexpr int kLines = flexcomp::test::cases(1000000);
  std::string text = "DEF p()\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\n";
  for (int i = 0; i < kLines; ++i) {
    text += "LIN {X " + std::to_string(i % 977) + ".125,Y -" + std::to_string(i % 331) +
            ".5,Z 0.75,A 0,B 90,C 0} C_DIS\n";
  }
  const auto begun = std::chrono::steady_clock::now();
  TEST_ASSERT_EQUAL(kLines + 1, krl_program("p.src", text, "").motions.size());
  TEST_ASSERT_TRUE(std::chrono::steady_clock::now() - begun < std::chrono::seconds(10));
}

/// A program as if every end were corrected by 0.1 mm along z, and the line in two.
CorrectedProgram corrected(const Program& source) {
  CorrectedProgram program;
  program.source = source;
  program.frame = source.frame.value_or(Pose<double>{});
  for (Motion motion : source.motions) {
    motion.end.position.z() += 1e-4;
    program.in_place.push_back({motion});
  }
  Motion halfway = program.in_place[1].front();
  halfway.end.position.z() += 0.01;
  program.in_place[1].insert(program.in_place[1].begin(), halfway);
  return program;
}

void a_program_of_its_own_keeps_all_that_does_not_move() {
  const Program source = krl_program("part.src", kInlineForms, kData);
  const std::string text = text_of(corrected(source), Format::krl, "part");
  std::string expected = kInlineForms;
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = expected.find(from);
    TEST_ASSERT_TRUE(at != std::string::npos);
    expected.replace(at, from.size(), to);
  };
  const std::string angles = "A 0.000000,B 90.000000,C 0.000000";
  replace("PTP XP1 C_PTP", "PTP {X 100.0000,Y 0.0000,Z 20.1000," + angles + "} C_PTP");
  replace("LIN XP2 C_DIS ;", "LIN {X 100.0000,Y 0.0000,Z 10.1000," + angles +
                                 "} C_DIS\nLIN {X 100.0000,Y 0.0000,Z 0.1000," + angles +
                                 "} C_DIS ;");
  const std::size_t circle = expected.find("CIRC");
  const std::size_t wrote = text.find("CIRC");
  TEST_ASSERT_EQUAL_STRING(expected.substr(0, circle).c_str(), text.substr(0, wrote).c_str());
  TEST_ASSERT_TRUE(text.find("\n$OUT[3]=TRUE\nEND\n") != std::string::npos);
}

void what_is_written_is_read_back() {
  const Program source = krl_program("part.src", kInlineForms, kData);
  const CorrectedProgram program = corrected(source);
  for (const Format format : {Format::krl}) {
    const Program again = krl_program("again.src", text_of(program, format, "again"), "");
    std::size_t at = 0;
    for (const auto& motions : program.in_place) {
      for (const Motion& motion : motions) {
        const Motion& read = again.motions.at(at++);
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0, (read.end.position - motion.end.position).norm());
        TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0, (read.end.rotation - motion.end.rotation).norm());
        TEST_ASSERT_TRUE(read.kind == motion.kind);
      }
    }
    TEST_ASSERT_EQUAL(at, again.motions.size());
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(inline_forms_move_to_the_points_of_the_data_list);
  RUN_TEST(angles_turn_about_z_then_y_then_x);
  RUN_TEST(angles_are_those_of_the_orientation);
  RUN_TEST(ca_goes_round_as_far_as_it_says);
  RUN_TEST(what_cannot_be_told_is_refused_with_its_line);
  RUN_TEST(unknown_words_are_noted_with_their_line);
  RUN_TEST(a_million_lines_are_read_in_seconds);
  RUN_TEST(a_program_of_its_own_keeps_all_that_does_not_move);
  RUN_TEST(what_is_written_is_read_back);
  return UNITY_END();
}
