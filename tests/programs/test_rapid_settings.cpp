// What a RAPID module sets for the motions behind it, and whether it surely does.
#include <cmath>
#include <string>

#include "programs/corrected_program.hpp"
#include "programs/positions.hpp"
#include "programs/rapid_reader.hpp"
#include "refusal.hpp"
#include "unity_main.hpp"

using flexcomp::test::assert_at;
using flexcomp::test::refusal_of;
using namespace flexcomp::programs;

namespace {

std::string module_of(const std::string& body) {
  return "MODULE m\nVAR robtarget p:=[[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
         "PROC main()\n" +
         body + "ENDPROC\nENDMODULE\n";
}

Program program_of(const std::string& body) { return rapid_program("m.mod", module_of(body)); }

void assert_refused(const std::string& expected, const std::string& body) {
  const std::string told = refusal_of([&] { program_of(body); });
  TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
}

constexpr const char* kGo = "MoveJ p,v100,fine,t;\n";
constexpr const char* kFurther = "MoveL Offs(p,100,0,0),v100,fine,t;\n";
constexpr const char* kElsewhere =
    "p:=[[0,200,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n";

std::string in_setup(const std::string& setup) {
  return "setup;\n" + std::string(kGo) + kFurther + "ENDPROC\nPROC setup()\n" + setup;
}

void what_a_routine_may_leave_out_is_not_counted_as_run() {
  const std::string kLeaving[] = {"IF d=1 RETURN;\n", "IF d=1 THEN\nRETURN;\nENDIF\n",
                                  "IF d=1 GOTO skip;\n"};
  for (const std::string& leaving : kLeaving) {
    const Program program = program_of("setup;\n" + std::string(kGo) + "ENDPROC\nPROC setup()\n" +
                                       leaving + kElsewhere + "skip:\n");
    TEST_ASSERT_EQUAL(0, program.motions.size());
    TEST_ASSERT_EQUAL(5, program.notes[0].line);
    TEST_ASSERT_EQUAL(0, program.notes[0].text.find("the module does not tell this point"));
  }
  assert_refused("m.mod:10: 'VELSET' here: the speed", in_setup("IF d=1 RETURN;\nVelSet 1,100;\n"));
  assert_refused("m.mod:4: 'PDISPSET' moves the points",
                 "PDispSet d;\n" + in_setup("IF d=1 RETURN;\nPDispOff;\n"));
}

/// IF d=1 setup; was passed over, whatever stands in the routine.
void a_routine_that_is_called_in_a_condition_may_have_run() {
  const std::string called = "IF d=1 setup;\n" + std::string(kGo) + "ENDPROC\nPROC setup()\n";
  const Program program = program_of(called + kElsewhere + "IF n>0 setup;\n");
  TEST_ASSERT_EQUAL(0, program.motions.size());
  TEST_ASSERT_EQUAL(5, program.notes[0].line);
  assert_refused("m.mod:8: 'VELSET' here: the speed", called + "VelSet 1,100;\n");
  assert_refused("m.mod:8: 'PDISPSET' moves the points", called + "PDispSet d;\n");
}

/// The doubt ends with the routine.
void what_stands_behind_the_call_is_run() {
  const Program program = program_of("setup;\n" + std::string(kElsewhere) + kGo +
                                     "ENDPROC\nPROC setup()\nIF d=1 RETURN;\nn:=1;\n");
  TEST_ASSERT_EQUAL(1, program.motions.size());
  assert_at(0, 200, 0, program.motions[0].end.position);
}

/// PDispOff ends what PDispSet does alone, and EOffsOff what EOffsSet does.
void each_displacement_is_ended_by_its_own_word() {
  assert_refused("m.mod:4: 'PDISPSET' moves the points",
                 "PDispSet d;\nEOffsOff;\n" + std::string(kGo));
  assert_refused("m.mod:4: 'EOFFSSET' moves the points",
                 "EOffsSet d;\nPDispOff;\n" + std::string(kGo));
  TEST_ASSERT_EQUAL(
      1, program_of("PDispSet d;\nEOffsSet d;\nPDispOff;\nEOffsOff;\n" + std::string(kGo))
             .motions.size());
}

/// The MoveL behind it was planned as a rapid from nowhere, and exported as a MoveJ.
void joint_motions_in_a_branch_are_refused() {
  const std::string to_home = "MoveAbsJ [[0,0,0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,t;\n";
  const std::string go = kGo;
  assert_refused("m.mod:6: a motion in a branch",
                 go + "IF d=1 THEN\n" + to_home + "ENDIF\n" + kFurther);
  assert_refused("m.mod:11: a motion in a branch", go + "IF d=1 THEN\nhome;\nENDIF\n" + kFurther +
                                                       "ENDPROC\nPROC home()\n" + to_home);
  assert_refused("m.mod:5: a motion in a branch",
                 go + "IF d=1 home;\n" + kFurther + "ENDPROC\nPROC home()\n" + to_home);
  assert_refused(
      "m.mod:9: 'RETURN': whether the motions",
      go + "home;\n" + kFurther + "ENDPROC\nPROC home()\n" + "IF d=1 RETURN;\n" + to_home);
}

void joint_motions_that_leave_external_axes_elsewhere_are_refused() {
  const std::string go = kGo;
  const std::string away = "MoveAbsJ [[0,0,0,0,0,0],[500,9E9,9E9,9E9,9E9,9E9]],v100,fine,t;\n";
  const std::string named = "CONST jointtarget j:=[[0,0,0,0,0,0],[500,9E9,9E9,9E9,9E9,9E9]];\n";
  assert_refused("m.mod:5: an external axis that moves", go + away + kFurther);
  assert_refused("m.mod:6: an external axis that moves",
                 go + named + "MoveAbsJ\\Conc,j\\NoEOffs,v100,fine,t;\n" + kFurther);
  // It stands there for all motions, or none is behind it.
  TEST_ASSERT_EQUAL(2, program_of(away + go + kFurther).motions.size());
  TEST_ASSERT_EQUAL(2, program_of(go + kFurther + away).motions.size());
}

/// A work object, a tool and a number that have an option's name are what they are declared as.
void an_options_name_is_no_variable() {
  const std::string header =
      "MODULE m\nPERS wobjdata "
      "wobj:=[FALSE,TRUE,\"\",[[600,0,300],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
      "PERS tooldata tool:=[TRUE,[[0,0,9],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
      "CONST num rz:=90;\nCONST robtarget q:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9]];\n"
      "PROC main()\nhere:=CRobT(\\Tool:=tool\\WObj:=wobj);\n"
      "MoveJ RelTool(q,1,2,3\\Rz:=rz),v100,fine,tool\\WObj:=wobj;\n";
  const std::string end = "ENDPROC\nENDMODULE\n";
  const Program program = rapid_program("m.mod", header + end);
  TEST_ASSERT_EQUAL(1, program.motions.size());
  assert_at(600, 0, 300, program.frame->position);
  assert_at(1, 2, 3, program.motions[0].end.position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 1, program.motions[0].end.rotation(1, 0));
  // What stands behind an option may still be set.
  TEST_ASSERT_EQUAL_STRING(
      "m.mod:8: 'WOBJ': the program changes this work object; its way is not planned",
      refusal_of([&] {
        rapid_program("m.mod", header + "IF Present(\\x) THEN wobj:=other;\nENDIF\n" + end);
      }).c_str());
}

void an_option_that_another_robot_hears_is_refused_or_kept() {
  const std::string go = kGo;
  assert_refused("m.mod:5: '\\ID': this option", go + "MoveL Offs(p,9,0,0)\\ID:=20,v100,z1,t;\n");
  assert_refused("m.mod:5: '\\ID': this option", go + "MoveL\\ID:=20,Offs(p,9,0,0),v100,z1,t;\n");
  CorrectedProgram program;
  program.source = program_of(go + "MoveL\\Conc,Offs(p,100,0,0),v100,z1,t;\n");
  Motion half = program.source.motions[1];
  half.end.position.x() = 0.05;
  program.in_place = {{program.source.motions[0]}, {half, program.source.motions[1]}};
  const std::string text = text_of(program, Format::rapid, "m");
  // What stands behind is run when the last part begins.
  TEST_ASSERT_TRUE(text.find("\nMoveL [[50.0000,") != std::string::npos);
  TEST_ASSERT_TRUE(text.find("\nMoveL\\Conc, [[100.0000,") != std::string::npos);
}

constexpr double kDegreeByHand = 0.017453292519943295;

/// Of [mm/s, degrees/s, …] the second number bounds how fast the tool turns. 500 degrees a second,
/// which v5 to v7000 have, are no bound.
void a_speeddata_bounds_the_turn() {
  const std::string go = kGo;
  const Program program = program_of(
      "CONST speeddata slow:=[25,6,5000,1000];\n" + go +
      "MoveL Offs(p,1,0,0),[100,3,5000,1000],z1,t;\nMoveL p,slow,z1,t;\nMoveL p,slow\\V:=9,z1,t;\n"
      "MoveL Offs(p,1,0,0),v100,z1,t;\nVelSet 10,5000;\nMoveL p,v100,z1,t;\n");
  const double expected[][2] = {{0.1, 3}, {0.025, 6}, {0.009, 6}, {0.1, 0}, {0.01, 50}};
  for (std::size_t i = 0; i < 5; ++i) {
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected[i][0], program.motions[i + 1].feed);
    TEST_ASSERT_DOUBLE_WITHIN(1e-12, expected[i][1] * kDegreeByHand,
                              program.motions[i + 1].turn_feed);
  }
}

void a_motion_behind_one_that_is_left_out_has_no_known_start() {
  const Program program = program_of("MoveAbsJ j,v100,fine,t;\n" + std::string(kGo) + kFurther +
                                     "MoveAbsJ j,v100,fine,t;\nMoveL p,v100,fine,t;\n" + kFurther);
  TEST_ASSERT_TRUE(program.motions[0].has_known_start);
  TEST_ASSERT_FALSE(program.motions[2].has_known_start);
  TEST_ASSERT_TRUE(program.motions[3].has_known_start);
  TEST_ASSERT_EQUAL(8, program.notes.back().line);
  TEST_ASSERT_TRUE(program.notes.back().text.find("the way here from line 6 is planned as") !=
                   std::string::npos);
}

/// 100 mm in 4 s are 25 mm/s.
void a_time_is_obeyed_where_vel_set_does_not_reach_it() {
  const std::string timed = "MoveL Offs(p,100,0,0),v100\\T:=4,fine,t;\n";
  const Program program = program_of("VelSet 100,26;\n" + std::string(kGo) + timed);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.025, program.motions[1].feed);
  assert_refused("m.mod:6: '\\T' behind VelSet", "VelSet 100,24;\n" + std::string(kGo) + timed);
}

void other_ways_to_turn_the_tool_are_refused() {
  const std::string both = std::string(kGo) + kFurther;
  const std::string arc = both + "MoveC Offs(p,150,50,0),Offs(p,200,0,0),v100,fine,t;\n";
  assert_refused("m.mod:4: 'SINGAREA \\WRIST' changes", "SingArea\\Wrist;\n" + both);
  assert_refused("m.mod:4: 'SINGAREA \\LOCKAXIS4' changes", "SingArea \\LockAxis4;\n" + both);
  assert_refused("m.mod:5: 'SINGAREA \\WRIST' changes",
                 "IF d=1 THEN\nSingArea\\Wrist;\nENDIF\n" + both);
  assert_refused("m.mod:4: 'CIRPATHMODE \\OBJECTFRAME' changes",
                 "CirPathMode\\ObjectFrame;\n" + arc);
  const std::string plain[] = {
      "SingArea\\Off;\nCirPathMode\\PathFrame;\n",
      "SingArea\\Wrist;\nSingArea\\Off;\nCirPathMode\\Wrist45;\nCirPathMode\\PathFrame;\n"};
  for (const std::string& each : plain) {
    TEST_ASSERT_EQUAL(3, program_of(each + arc).motions.size());
  }
  TEST_ASSERT_EQUAL(2, program_of("CirPathMode\\ObjectFrame;\n" + both).motions.size());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(what_a_routine_may_leave_out_is_not_counted_as_run);
  RUN_TEST(a_routine_that_is_called_in_a_condition_may_have_run);
  RUN_TEST(what_stands_behind_the_call_is_run);
  RUN_TEST(each_displacement_is_ended_by_its_own_word);
  RUN_TEST(joint_motions_in_a_branch_are_refused);
  RUN_TEST(joint_motions_that_leave_external_axes_elsewhere_are_refused);
  RUN_TEST(an_options_name_is_no_variable);
  RUN_TEST(an_option_that_another_robot_hears_is_refused_or_kept);
  RUN_TEST(a_speeddata_bounds_the_turn);
  RUN_TEST(a_motion_behind_one_that_is_left_out_has_no_known_start);
  RUN_TEST(other_ways_to_turn_the_tool_are_refused);
  RUN_TEST(a_time_is_obeyed_where_vel_set_does_not_reach_it);
  return UNITY_END();
}
