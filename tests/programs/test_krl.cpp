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
      {"q()\nEND\nGLOBAL DEF q()\nLIN {X 1}\n", "p.src:6: a motion in a second routine"},
      {"END\nglobal deffct INT q()\nLIN {X 1}\n", "p.src:5: a motion in a second routine"},
      {"$BASE={X 2,Y 0,Z 0,A 0,B 0,C 0}\nLIN {X 1}\n", "p.src:3: a second $BASE"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told = refusal(start + text);
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
  TEST_ASSERT_EQUAL_STRING(
      "p.src:2: the point lacks some of X, Y, Z, A, B and C, and no point "
      "before it tells them",
      refusal("DEF p()\nLIN {X 1}\n").c_str());
}

/// What stands behind a call would else hold for the motions of what is called.
void motions_of_a_routine_that_is_called_are_refused_though_the_first_has_none() {
  const std::string called = "END\nDEF q()\nPTP {X 1,Y 0,Z 0,A 0,B 0,C 0}\nEND\n";
  for (const char* first : {"q()\n$VEL.CP=2\n", "FOR I=1 TO 3\nq()\n", "PTP HOME\n;\n", ";\n;\n"}) {
    const std::string told = refusal(std::string("DEF p()\n") + first + called);
    TEST_ASSERT_EQUAL_STRING(
        "p.src:6: a motion in a second routine: when it is called cannot be told", told.c_str());
  }
  TEST_ASSERT_EQUAL(1, krl_program("p.src",
                                   "DEF p()\nINIT()\nPTP {X 1,Y 0,Z 0,A 0,B 0,C 0}\nEND\n"
                                   "DEF INIT()\n$OUT[3]=TRUE\nEND\n",
                                   "")
                           .motions.size());
}

/// All of these were passed over in silence once.
void what_changes_the_way_and_is_not_read_is_refused_with_its_line() {
  const std::string start =
      "DEF p()\n$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}\nPTP {X 10,Y 0,Z 0,A 0,B 0,C 0}\n";
  const std::string refusals[][2] = {
      {"LIN {X 1,Y 0,Z 0} : {Z 5}\n", "p.src:4: '{...}': a point that is computed"},
      {"LIN {X 1} {X 2}\n", "p.src:4: '{X 2}' behind the point is not read"},
      {"$VEL.CP=0.5*0.1\n", "p.src:4: expected a number alone, found '*0.1'"},
      {"BAS(#VEL_CP,0.5*0.1)\n", "p.src:4: expected a number alone, found '*0.1)'"},
      {"LIN {X 1,E1 500}\n", "p.src:4: an external axis (E1 to E6) that moves"},
      {"LIN {X 1,E1 0}\nLIN {X 1,E1 5}\n", "p.src:5: an external axis (E1 to E6) that moves"},
      {"LIN_REL {E1 5}\n", "p.src:4: an external axis (E1 to E6) that moves"},
      {"LIN {X 1,Q 5}\n", "p.src:4: 'Q' is no component of a point"},
      {"LIN {X 1,X 2}\n", "p.src:4: 'X' stands twice in a point"},
      {"$IPO_MODE=#TCP\nLIN {X 1}\n", "p.src:4: '$IPO_MODE' other than #BASE"},
      {"$ORI_TYPE=#CONSTANT\nLIN {X 1}\n", "p.src:4: '$ORI_TYPE' other than #VAR"},
      {"$CIRC_TYPE=#PATH\nLIN {X 1}\n", "p.src:4: '$CIRC_TYPE' other than #BASE"},
      {"$CIRC_MODE={AUX_PT {ORI #CONSIDER}}\nLIN {X 1}\n", "p.src:4: '$CIRC_MODE' is not read"},
      {"$BASE.X=1700\nLIN {X 1}\n", "p.src:4: '$BASE.X': a component alone is not read"},
      {"$BASE=BASE_DATA[3]\nLIN {X 1}\n", "p.src:4: a second $BASE"},
      {"BAS(#BASE,3)\nLIN {X 1}\n", "p.src:4: a second $BASE"},
      {"BAS(#TOOL,3)\nLIN {X 1}\n", "p.src:4: a second $TOOL"},
      {"BAS(#EX_BASE,3)\nLIN {X 1}\n", "p.src:4: '#EX_BASE'"},
      {"IF $IN[1] THEN\nRETURN\nENDIF\nLIN {X 1}\n", "p.src:5: 'RETURN': whether the motions"},
      {"EXIT\nLIN {X 1}\n", "p.src:4: 'EXIT': whether the motions"},
      {"GOTO L1\nLIN {X 1}\nL1:\n", "p.src:4: 'GOTO': whether the motions"},
      {"IF $IN[1] THEN LIN {X 1}\nENDIF\n", "p.src:4: a statement in the line of its IF"},
      {"FOR I=1 TO 2\n$VEL.CP=$VEL.CP/2\nENDFOR\nLIN {X 1}\n", "p.src:5: '$VEL.CP' in a branch"},
      {"END\nDEF q()\n$VEL.CP=0.1\nEND\n", "p.src:6: '$VEL.CP' in a second routine"},
      {"$OV_PRO=OV\nLIN {X 1}\n", "p.src:4: '$OV_PRO': expected a number"},
      {"SLIN {X 1} WITH $BASE=SBASE(3)\n", "p.src:4: a second base, BASE_DATA[3]"},
      {"SLIN {X 1} WITH $TOOL=STOOL2(3)\n", "p.src:4: a second tool, TOOL_DATA[3]"},
      {"SLIN {X 1} WITH $ORI_TYPE=#JOINT\n", "p.src:4: '$ORI_TYPE' other than #VAR"},
      {"SLIN {X 1} WITH $VEL.CP=0.5*0.1\n", "p.src:4: '*0.1' behind the point is not read"},
      {"SLIN {X 1} WITH $CORR=1\n", "p.src:4: '$CORR': this setting of a motion is not read"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told = refusal(start + text);
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
}

void what_changes_nothing_is_read_as_ever() {
  const Program program = krl_program(
      "p.src",
      "DEF p()\n$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}\n$IPO_MODE=#BASE\n$ORI_TYPE=#VAR\n"
      "PTP {X 10,Y 0,Z 0,A 0,B 0,C 0,S 'B010',T 'B1011',E1 0}\nLIN {X 1,E1 0.0,E2 0} C_DIS C_ORI\n"
      "LOOP\nIF $IN[1] THEN\nEXIT\nENDIF\nENDLOOP\nLIN_REL {Y 2} C_VEL #BASE\n"
      "$BASE={X 1,Y 0,Z 0,A 0,B 0,C 0}\nLIN {X 2}\nIF $IN[1] THEN\nRETURN\nENDIF\nEND\n",
      "");
  TEST_ASSERT_EQUAL(4, program.motions.size());
  assert_at(2, 2, 0, program.motions[3].end.position);
  TEST_ASSERT_EQUAL(1, program.notes.size());
  TEST_ASSERT_EQUAL(5, program.notes[0].line);
  TEST_ASSERT_TRUE(program.notes[0].text.find("posture that S and T") != std::string::npos);
}

/// A turn by 90° about z puts the second frame's x along the first one's y.
void a_product_of_frames_is_the_second_in_the_first() {
  const Program program =
      krl_program("p.src",
                  "DEF p()\n$BASE={X 1600,Y 0,Z 800,A 90,B 0,C 0}:{X 100,Y 0,Z 0,A 0,B 0,C 0}\n"
                  "XP1={X 10,Y 20,Z 30,A 90,B 0,C 0}\nLIN XP1:{X 5,Y 0,Z 1,A 0,B 90,C 0} C_DIS\n"
                  "LIN {X 0}\nEND\n",
                  "");
  assert_at(1600, 100, 800, program.frame->position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, program.frame->rotation(1, 0));
  assert_at(10, 25, 31, program.motions[0].end.position);
  const Vector3<double> axis = program.motions[0].end.rotation.col(2);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (axis - Vector3<double>::UnitY()).norm());
}

void feeds_follow_the_override_and_what_a_motion_sets_for_itself() {
  const Program program = krl_program(
      "p.src",
      "DEF p()\n$VEL={CP 0.1,ORI1 200.0}\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\n"
      "SLIN {X 1} WITH $VEL=SVEL_CP(0.02, , LC), $ACC=SACC_CP(LC), $LOAD=SLOAD(1) C_SPL\n"
      "LIN {X 2}\n$OV_PRO=50\nLIN {X 3}\nSLIN {X 4} WITH $VEL.CP=0.04\nEND\n",
      "");
  const double feeds[] = {0, 0.02, 0.1, 0.05, 0.02};
  for (std::size_t i = 0; i < 5; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, feeds[i], program.motions[i].feed);
  }
}

/// ORI1 swivels the tool and ORI2 turns it about itself, in degrees a second: the slower holds.
void turning_is_as_fast_as_the_program_says() {
  const Program program = krl_program(
      "p.src",
      "DEF p()\n$VEL={CP 0.1,ORI1 90,ORI2 180}\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\nLIN {A 10}\n"
      "$VEL.ORI2=VTURN\n$OV_PRO=50\nLIN {A 20}\n$VEL.ORI1=$VEL_MA.ORI1\n"
      "$VEL.ORI2=$VEL_MA.ORI2\nLIN {A 30}\nEND\n",
      "DECL REAL VTURN=36\n");
  const double turn_feeds[] = {0, M_PI / 2, M_PI / 10, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, turn_feeds[i], program.motions[i].turn_feed);
  }
  TEST_ASSERT_EQUAL(0, program.notes.size());
}

void a_feed_by_name_is_the_number_that_the_files_give() {
  const Program program = krl_program(
      "p.src",
      "DEF p()\nREAL VLOW\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\n$VEL.CP=VCUT\nLIN {X 1}\nVLOW=0.001\n"
      "$VEL={CP VLOW}\nLIN {X 2}\nBAS(#VEL_CP,VCUT)\nLIN {X 3}\n"
      "SLIN {X 4} WITH $VEL.CP=VLOW\n$VEL.CP=VELSEWHERE\nLIN {X 5}\nEND\n",
      "DEFDAT p\nDECL GLOBAL REAL VFAST=2,VCUT=0.03\nENDDAT\n");
  const double feeds[] = {0, 0.03, 0.001, 0.03, 0.001, 0.03};
  for (std::size_t i = 0; i < 6; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, feeds[i], program.motions[i].feed);
  }
  TEST_ASSERT_EQUAL(1, program.notes.size());
  TEST_ASSERT_EQUAL(12, program.notes[0].line);
}

void a_feed_that_is_computed_is_refused_with_its_line() {
  const std::string refusals[][2] = {
      {"$VEL.CP=V*2\n", "p.src:4: expected a number alone, found '*2'"},
      {"$VEL.CP=SPEED(3)\n", "p.src:4: expected a number alone, found '(3)'"},
      {"$VEL.CP=-V\n", "p.src:4: expected a number or a name, found '-V'"},
      {"$VEL={CP V*2}\n", "p.src:4: expected speeds such as"},
      {"BAS(#VEL_CP,V*2)\n", "p.src:4: expected a number alone, found '*2)'"},
      {"SLIN {X 1} WITH $VEL.CP=SPEED(3)\n", "p.src:4: '$VEL.CP': this setting"},
      {"V=V/2\n$VEL.CP=V\n", "p.src:5: 'V': a number that is computed cannot be told"},
      {"FOR V=1 TO 3\nENDFOR\n$VEL.CP=V\n", "p.src:6: 'V': a number that is computed"},
      {"IF $IN[1] THEN\nV=2\nENDIF\n$VEL.CP=V\n", "p.src:7: 'V': a number that is computed"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told =
        refusal("DEF p()\nV=0.1\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\n" + text + "LIN {X 1}\nEND\n");
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
}

void what_stands_behind_return_is_not_run() {
  const Program program = krl_program(
      "p.src", "DEF p()\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\nLIN {X 1}\nRETURN\nLIN {X 9}\nEND\n", "");
  TEST_ASSERT_EQUAL(2, program.motions.size());
  TEST_ASSERT_EQUAL(5, program.notes[0].line);
}

/// Programs of the pendant: BAS loads tool and base by the numbers of FDAT_ACT.
std::string of_the_pendant(int base_of_second) {
  return "DEF part( )\nFDAT_ACT=FHOME\nBAS(#PTP_PARAMS,100)\nPTP XHOME\n"
         "PDAT_ACT=PPDAT1\nFDAT_ACT=FP1\nBAS(#PTP_PARAMS,100)\nPTP XP1\n"
         "LDAT_ACT=LCPDAT1\nFDAT_ACT=FP" +
         std::to_string(base_of_second) + "\nBAS(#CP_PARAMS,0.02)\nLIN XP2 C_DIS\nEND\n";
}
constexpr const char* kPendantData =
    "DEFDAT part\nDECL E6POS XP1={X 0.0,Y 0.0,Z 50.0,A 0.0,B 90.0,C 0.0,S 2,T 35,E1 0.0}\n"
    "DECL FDAT FP1={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE,POINT2[] \" \",TQ_STATE FALSE}\n"
    "DECL FDAT FP2={TOOL_NO 1,BASE_NO 2,IPO_FRAME #BASE,POINT2[] \" \"}\n"
    "DECL FDAT FP3={TOOL_NO 1,BASE_NO 3,IPO_FRAME #BASE,POINT2[] \" \"}\n"
    "DECL FDAT FP4={TOOL_NO 4,BASE_NO 2,IPO_FRAME #BASE,POINT2[] \" \"}\n"
    "DECL FDAT FP5={TOOL_NO 1,BASE_NO 2,IPO_FRAME #TCP,POINT2[] \" \"}\n"
    "DECL LDAT LCPDAT1={VEL 2.0,ACC 100.0,APO_DIST 100.0,ORI_TYP #VAR,CIRC_TYP #BASE}\n"
    "DECL E6POS XP2={X 20.0,Y 0.0,Z 0.0,A 0.0,B 90.0,C 0.0,S 2,T 35,E1 0.0}\nENDDAT\n";

void tool_and_base_by_number_are_those_of_all_motions_or_refused() {
  const Program program = krl_program("p.src", of_the_pendant(2), kPendantData);
  TEST_ASSERT_EQUAL(2, program.motions.size());
  TEST_ASSERT_FALSE(program.frame.has_value());
  bool is_told = false;
  for (const Note& note : program.notes) {
    is_told = is_told || (note.line == 7 && note.text.find("'$BASE': BASE_DATA[2] is not in the "
                                                           "file") == 0);
  }
  TEST_ASSERT_TRUE(is_told);
  const std::string refusals[] = {"p.src:12: a second base, BASE_DATA[3]",
                                  "p.src:12: a second tool, TOOL_DATA[4]",
                                  "p.src:12: a motion with the tool standing still"};
  for (int i = 0; i < 3; ++i) {
    const std::string told =
        refusal_of([&] { krl_program("p.src", of_the_pendant(3 + i), kPendantData); });
    TEST_ASSERT_EQUAL_STRING(refusals[i].c_str(), told.substr(0, refusals[i].size()).c_str());
  }
}

void an_orientation_that_stays_is_refused_where_an_ldat_asks_for_it() {
  std::string data = kPendantData;
  data.replace(data.find("#VAR"), 4, "#CONSTANT");
  const std::string told = refusal_of([&] { krl_program("p.src", of_the_pendant(2), data); });
  TEST_ASSERT_EQUAL_STRING("p.src:11: ORI_TYP #CONSTANT", told.substr(0, 27).c_str());
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
  const std::string axes = ",E1 0,E2 0";
  replace("PTP XP1 C_PTP", "PTP {X 100.0000,Y 0.0000,Z 20.1000," + angles + axes + "} C_PTP");
  replace("LIN XP2 C_DIS ;", "LIN {X 100.0000,Y 0.0000,Z 10.1000," + angles +
                                 "} C_DIS\nLIN {X 100.0000,Y 0.0000,Z 0.1000," + angles + axes +
                                 "} C_DIS ;");
  const std::size_t circle = expected.find("CIRC");
  const std::size_t wrote = text.find("CIRC");
  TEST_ASSERT_EQUAL_STRING(expected.substr(0, circle).c_str(), text.substr(0, wrote).c_str());
  TEST_ASSERT_TRUE(text.find("\n$OUT[3]=TRUE\nEND\n") != std::string::npos);
}

/// BAS would load base 2 again: a $BASE that was guessed would hold for the first motion alone.
void a_base_by_number_that_no_file_tells_stays_the_programs() {
  CorrectedProgram program = corrected(krl_program("part.src", of_the_pendant(2), kPendantData));
  program.frame.position = {1.7, 0, 0.4};
  const std::string text = text_of(program, Format::krl, "part");
  TEST_ASSERT_TRUE(text.find("$BASE") == std::string::npos);
  TEST_ASSERT_TRUE(text.find("; the points below are corrected for a base at {X 1700.0000,Y 0.0000,"
                             "Z 400.0000,") != std::string::npos);
  TEST_ASSERT_TRUE(text.find("\nLIN {X 20.0000,Y 0.0000,Z 0.1000,") != std::string::npos);
}

/// The job is moved by 100 mm along y of the world, which is x of a base that is turned by 90°.
/// The program loads that base again, so its points are moved.
void points_of_a_moved_job_are_moved_in_a_base_by_number() {
  const std::string base = "BASE_DATA[2]={X 1600,Y 0,Z 800,A 90,B 0,C 0}\n";
  CorrectedProgram program = corrected(
      krl_program("part.src", "DEF part( )\n" + base + of_the_pendant(2).substr(12), kPendantData));
  assert_at(1600, 0, 800, program.frame.position);
  program.frame.position.y() += 0.1;
  const std::string text = text_of(program, Format::krl, "part");
  TEST_ASSERT_TRUE(text.find("$BASE") == std::string::npos);
  TEST_ASSERT_TRUE(text.find("\nLIN {X 120.0000,Y 0.0000,Z 0.1000,") != std::string::npos);
}

void what_is_computed_of_a_target_is_written_once() {
  CorrectedProgram program =
      corrected(krl_program("p.src",
                            "DEF p()\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\n"
                            "LIN {X 1,Y 0,Z 0,A 0,B 90,C 0}:{X 0,Y 0,Z 5,A 0,B 0,C 0} C_DIS\nEND\n",
                            ""));
  const std::string text = text_of(program, Format::krl, "p");
  TEST_ASSERT_TRUE(text.find("\nLIN {X 6.0000,Y 0.0000,Z 0.1000,A 0.000000,B 90.000000,C "
                             "0.000000} C_DIS\nEND\n") != std::string::npos);
}

/// A program of one line, behind a point at zero, as it is written when nothing is corrected.
std::string line_written(const std::string& line, const std::string& dat = {}) {
  CorrectedProgram program;
  program.source =
      krl_program("p.src", "DEF p()\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\n" + line + "\nEND\n", dat);
  for (const Motion& motion : program.source.motions) {
    program.in_place.push_back({motion});
  }
  const std::string text = text_of(program, Format::krl, "p");
  const std::size_t begin = text.rfind("\nLIN ") + 1;
  return text.substr(begin, text.find('\n', begin) - begin);
}

constexpr const char* kAtOne = "X 1.0000,Y 0.0000,Z 0.0000,A 0.000000,B 90.000000,C 0.000000";

void external_axes_before_a_blank_are_written_in_one_pair_of_braces() {
  TEST_ASSERT_EQUAL_STRING(("LIN {" + std::string(kAtOne) + ",E1 0,E2 0} C_DIS").c_str(),
                           line_written("LIN {X 1,E1 0,E2 0} C_DIS").c_str());
}

/// The axis stands at 500 mm: written without it, the first point would be gone to from elsewhere.
void external_axes_of_named_points_are_written() {
  CorrectedProgram program;
  program.source =
      krl_program("p.src", "DEF p()\nPTP XP1\nLIN XP2 C_DIS\nLIN_REL {X 1,E1 0} C_DIS\nEND\n",
                  "E6POS XP1={X 0,Y 0,Z 0,A 0,B 90,C 0,S 2,T 10,E1 500.5,E3 -90}\n"
                  "E6POS XP2={X 5,Y 0,Z 0,A 0,B 90,C 0,S 2,T 10,E1 500.5,E3 -90}\n");
  for (const Motion& motion : program.source.motions) {
    program.in_place.push_back({motion});
  }
  const std::string rest = ".0000,Y 0.0000,Z 0.0000,A 0.000000,B 90.000000,C 0.000000";
  const std::string text = text_of(program, Format::krl, "p");
  TEST_ASSERT_EQUAL_STRING(("PTP {X 0" + rest + ",E1 500.5,E3 -90}\nLIN {X 5" + rest +
                            ",E1 500.5,E3 -90} C_DIS\nLIN {X 6" + rest + "} C_DIS\nEND\n")
                               .c_str(),
                           text.substr(text.find("PTP")).c_str());
}

/// Where HOME is, no file tells: a straight way past it may go through the work.
void another_language_stops_where_the_way_is_not_told() {
  CorrectedProgram program;
  program.source = krl_program("p.src",
                               "DEF p()\nPTP HOME\nPTP {X 0,Y 0,Z 0,A 0,B 90,C 0}\nLIN {X 1}\n"
                               "PTP HOME\nLIN {X 9,Y 0,Z 5,A 0,B 90,C 0}\nLIN {X 8}\n"
                               "PTP {A1 0,A2 -90}\nPTP {X 7,Y 0,Z 5,A 0,B 90,C 0}\nEND\n",
                               "");
  const bool are_known[] = {true, true, false, true, false};
  for (std::size_t i = 0; i < 5; ++i) {
    const Motion& motion = program.source.motions[i];
    TEST_ASSERT_EQUAL(are_known[i], motion.has_known_start);
    program.in_place.push_back({motion});
  }
  TEST_ASSERT_EQUAL(6, program.source.notes[2].line);
  TEST_ASSERT_EQUAL_STRING(
      "the place before is not told; the way here from line 4 is planned as straight",
      program.source.notes[2].text.c_str());
  const std::string rapid = text_of(program, Format::rapid, "p");
  const std::size_t stop = rapid.find("  ! PTP HOME\n  Stop; ! the source does not tell the way");
  TEST_ASSERT_TRUE(stop != std::string::npos);
  TEST_ASSERT_TRUE(rapid.find("[[1.0000,0.0000,0.0000]") < stop);
  TEST_ASSERT_TRUE(rapid.find("[[9.0000,0.0000,5.0000]") > stop);
}

void the_frame_of_a_relative_motion_is_not_written_behind_a_place() {
  const std::string at_one = "LIN {" + std::string(kAtOne) + "}";
  const std::string lines[][2] = {{"LIN_REL {X 1} C_DIS #BASE", " C_DIS"},
                                  {"LIN_REL {X 1} # base C_DIS", " C_DIS"},
                                  {"LIN_REL {X 1} #BASE", ""},
                                  {"LIN_REL {X 1} C_DIS", " C_DIS"}};
  for (const auto& [line, tail] : lines) {
    TEST_ASSERT_EQUAL_STRING((at_one + tail).c_str(), line_written(line).c_str());
  }
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
  RUN_TEST(motions_of_a_routine_that_is_called_are_refused_though_the_first_has_none);
  RUN_TEST(unknown_words_are_noted_with_their_line);
  RUN_TEST(a_million_lines_are_read_in_seconds);
  RUN_TEST(a_program_of_its_own_keeps_all_that_does_not_move);
  RUN_TEST(what_changes_the_way_and_is_not_read_is_refused_with_its_line);
  RUN_TEST(what_changes_nothing_is_read_as_ever);
  RUN_TEST(a_product_of_frames_is_the_second_in_the_first);
  RUN_TEST(feeds_follow_the_override_and_what_a_motion_sets_for_itself);
  RUN_TEST(turning_is_as_fast_as_the_program_says);
  RUN_TEST(a_feed_by_name_is_the_number_that_the_files_give);
  RUN_TEST(a_feed_that_is_computed_is_refused_with_its_line);
  RUN_TEST(what_stands_behind_return_is_not_run);
  RUN_TEST(tool_and_base_by_number_are_those_of_all_motions_or_refused);
  RUN_TEST(an_orientation_that_stays_is_refused_where_an_ldat_asks_for_it);
  RUN_TEST(a_base_by_number_that_no_file_tells_stays_the_programs);
  RUN_TEST(points_of_a_moved_job_are_moved_in_a_base_by_number);
  RUN_TEST(what_is_computed_of_a_target_is_written_once);
  RUN_TEST(external_axes_before_a_blank_are_written_in_one_pair_of_braces);
  RUN_TEST(external_axes_of_named_points_are_written);
  RUN_TEST(another_language_stops_where_the_way_is_not_told);
  RUN_TEST(the_frame_of_a_relative_motion_is_not_written_behind_a_place);
  RUN_TEST(what_is_written_is_read_back);
  return UNITY_END();
}
