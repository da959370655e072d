// RAPID as ABB's reference and programs that others published have it: targets by name, by Offs and
// RelTool, declared below the routine that uses them, work objects, statements over several lines.
#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "programs/corrected_program.hpp"
#include "programs/positions.hpp"
#include "programs/rapid_reader.hpp"
#include "refusal.hpp"
#include "unity_main.hpp"

using flexcomp::Pose;
using flexcomp::Vector3;
using flexcomp::test::assert_at;
using flexcomp::test::refusal_of;
using namespace flexcomp::programs;

namespace {

std::string refusal(const std::string& text) {
  return refusal_of([&] { rapid_program("m.mod", text); });
}

constexpr const char* kModule =
    "%%%\n  VERSION:1\n  LANGUAGE:ENGLISH\n%%%\nMODULE Sign\n"
    "  PERS tooldata tPen:=[TRUE,[[0,0,200],[1,0,0,0]],[1,[0,0,80],[1,0,0,0],0,0,0]];\n"
    "  TASK PERS wobjdata wTable:=[FALSE,TRUE,\"\",[[600,0,300],[0.707106781,0,0,0.707106781]],\n"
    "    [[0,10,0],[1,0,0,0]]];\n"
    "  CONST speeddata vSlow:=[25,500,5000,1000];\n"
    "  PROC main()\n    ConfL\\Off; ! no matter which\n"
    "    MoveAbsJ jHome\\NoEOffs,v1000,z50,tPen;\n"
    "    MoveJ Offs (pMid,50,0,20), v1000, z10, tPen\\WObj:=wTable;\n"
    "    MoveL Offs(pMid,50,0,0),\n      v100,fine,tPen\\WObj:=wTable; ! down; to the edge\n"
    "    MoveC Offs(pMid,0,50,0),Offs(pMid,-50,0,0),vSlow,z1,tPen\\WObj:=wTable;\n"
    "    MoveL RelTool(pMid,0,0,-20),v200\\V:=150,z5,tPen\\WObj:=wTable;\n"
    "    TPWrite \"done; really!\";\n  ENDPROC\n"
    "  LOCAL CONST robtarget pMid:=[[10,20,30],[0,0,1,0],[0,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "ENDMODULE\n";

void targets_are_found_wherever_they_are_declared() {
  const Program program = rapid_program("sign.mod", kModule);
  TEST_ASSERT_EQUAL(4, program.motions.size());
  assert_at(60, 20, 50, program.motions[0].end.position);
  TEST_ASSERT_EQUAL(13, program.motions[0].line);
  assert_at(60, 20, 30, program.motions[1].end.position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.1, program.motions[1].feed);
  assert_at(-40, 20, 30, program.motions[2].end.position);
  assert_at(10, 70, 30, pose_at(program.motions[1].end, program.motions[2], 0.5).position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.025, program.motions[2].feed);
  // Turned by half a turn about y the tool points down: back along it is up.
  assert_at(10, 20, 50, program.motions[3].end.position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.15, program.motions[3].feed);
  TEST_ASSERT_EQUAL(2, program.notes.size());
  TEST_ASSERT_EQUAL(12, program.notes[0].line);
  TEST_ASSERT_EQUAL(13, program.notes[1].line);
  TEST_ASSERT_TRUE(program.notes[1].text.find("the posture that the configuration gives") == 0);
}

/// The object frame stands in the user frame, which is turned by a quarter about z.
void the_work_object_is_user_frame_times_object_frame() {
  const Program program = rapid_program("sign.mod", kModule);
  assert_at(590, 0, 300, program.frame->position);
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, 1, program.frame->rotation(1, 0));
}

void what_cannot_be_told_is_refused_with_its_line() {
  const std::string start = "MODULE m\nPROC main()\n";
  const std::string target = "[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]";
  const std::string refusals[][2] = {
      {"MoveL p10,v100,fine,tool0;\n", "m.mod:3: the point is not one that this module tells"},
      {"IF a=1 THEN\nMoveL " + target + ",v100,fine,tool0;\nENDIF\n",
       "m.mod:4: a motion in a branch or a loop"},
      {"IF a=1 MoveL " + target + ",v100,fine,tool0;\n", "m.mod:3: a motion in a branch or a loop"},
      {"TriggL p10,v100,t1,fine,tool0;\n", "m.mod:3: 'TRIGGL': this motion is not read"},
      {"MoveL " + target + ",v100,fine,tool0;\nENDPROC\nPROC b()\nMoveL " + target +
           ",v100,fine,tool0;\n",
       "m.mod:6: a motion in a second routine"},
      {"MoveL " + target + ",v100,fine,tool0;\nMoveL " + target + ",v100,fine,tool0\\WObj:=w2;\n",
       "m.mod:4: 'W2': a second work object"},
      {"MoveC " + target + "," + target + ",v100,fine,tool0;\n",
       "m.mod:3: a circle from a point that the module does not tell"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told = refusal(start + text);
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
}

/// All of these were passed over in silence once, or noted alone.
void what_changes_the_way_and_is_not_read_is_refused_with_its_line() {
  const std::string start =
      "MODULE m\nPERS wobjdata wHeld:=[TRUE,TRUE,\"\",[[1,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
      "PERS wobjdata wTurned:=[FALSE,FALSE,\"STN1\",[[1,0,0],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n"
      "PERS tooldata tStands:=[FALSE,[[0,0,9],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n"
      "CONST robtarget p:=[[1,2,3],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "CONST robtarget pFar:=[[1,2,3],[1,0,0,0],[0,0,0,0],[1000,9E9,9E9,9E9,9E9,9E9]];\n"
      "PROC main()\n";
  const std::string go = "MoveJ p,v100,fine,t;\n";
  const std::string further = "MoveL Offs(p,1,0,0),v100,fine,t;\n";
  const std::string refusals[][2] = {
      {"MoveJ p,v100,fine,t\\WObj:=wHeld;\n", "m.mod:8: 'WHELD': the robot holds this work"},
      {"MoveJ p,v100,fine,t\\WObj:=wTurned;\n", "m.mod:8: 'WTURNED': a mechanical unit moves"},
      {"MoveJ p,v100,fine,tStands;\n", "m.mod:8: 'TSTANDS': a tool that the robot does not hold"},
      {go + "MoveL p,v100,fine,t2;\n", "m.mod:9: 'T2': a second tool"},
      {go + "MoveL pFar,v100,fine,t;\n", "m.mod:9: an external axis that moves"},
      {go + "MoveL p,v100,fine,t\\Corr;\n", "m.mod:9: '\\CORR': this option of a motion"},
      {go + "MoveL p,v100*2,fine,t;\n", "m.mod:9: expected a comma and the zone"},
      {go + "MoveL p,v100,fine,t+1;\n", "m.mod:9: '+1' behind the tool is not read"},
      {"PDispSet [[100,0,0],[1,0,0,0]];\n" + go, "m.mod:8: 'PDISPSET' moves the points"},
      {go + "EOffsSet [100,0,0,0,0,0];\n" + further, "m.mod:9: 'EOFFSSET' moves the points"},
      {go + "GOTO a;\n" + further + "a:\n", "m.mod:9: 'GOTO': whether the motions"},
      {"a:\n" + go + "IF b GOTO a;\n", "m.mod:8: a motion behind a label"},
      {go + "IF b RETURN;\n" + further, "m.mod:9: 'RETURN': whether the motions"},
      {go + "IF b THEN\nRETURN;\nENDIF\n" + further, "m.mod:10: 'RETURN': whether the motions"},
      {go + "IF b VelSet 10,100;\n" + further, "m.mod:9: 'VELSET' here: the speed"},
      {go + "SpeedRefresh 50;\n" + further, "m.mod:9: 'SPEEDREFRESH' here: the speed"},
      {go + "VelSet 50,800;\nMoveL Offs(p,1,0,0),v100\\T:=5,fine,t;\n", "m.mod:10: '\\T' behind"},
      {go + "FOR i FROM 1 TO 2 DO " + further + "ENDFOR\n", "m.mod:9: a motion in a branch"},
      {go + "TEST i\nCASE 1: " + further + "ENDTEST\n", "m.mod:10: a motion in a branch"},
      {go + "IF b THEN\nENDIF " + further, "m.mod:10: a motion in the line of another"},
      {go + "ERROR\n" + further, "m.mod:10: a motion in a branch"},
      {"cut;\ncut;\nENDPROC\nPROC cut()\n" + go, "m.mod:9: 'CUT' is called a second time"},
      {"cut 5;\nENDPROC\nPROC cut(num a)\n" + go, "m.mod:8: 'CUT' moves with arguments"},
      {"IF a cut;\nENDPROC\nPROC cut()\n" + go, "m.mod:8: a motion in a branch"},
      {"cut;\nENDPROC\nPROC cut()\n" + go + "cut;\n", "m.mod:12: 'CUT' calls itself"},
      {go + "PROC cut()\n" + further, "m.mod:9: a routine in another one"},
      {go + "ENDPROC\nPROC main()\n" + further, "m.mod:11: a motion in a second routine"},
      {go + "ENDPROC\n" + further, "m.mod:10: a motion outside of all routines"},
      {go + "ENDPROC\nPROC cut()\n" + go, "m.mod:11: a motion in a second routine"}};
  for (const auto& [text, expected] : refusals) {
    const std::string told = refusal(start + text + "ENDPROC\nENDMODULE\n");
    TEST_ASSERT_EQUAL_STRING(expected.c_str(), told.substr(0, expected.size()).c_str());
  }
}

/// As RobotStudio writes it: main calls Path_20 and Path_10, of which Path_10 stands first.
constexpr const char* kPaths =
    "MODULE Module1\n"
    "  CONST robtarget p:=[[100,0,50],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
    "  VAR robtarget pt{2}:=[[[10,0,0],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],\n"
    "    [[20,0,0],[0,0,1,0],[0,1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];\n"
    "  CONST num dx:=10;\n  PERS num dz:=5;\n"
    "  PROC main()\n    Path_20;\n    Path_10;\n  ENDPROC\n"
    "  PROC Path_10()\n    MoveL Offs(p,-dx,2*(dx+1),dz/2),v100,fine,t;\n    MoveL "
    "pt{2},v100,fine,t;\n"
    "  ENDPROC\n"
    "  PROC Path_20()\n    MoveJ p,v100,fine,t;\n    IF a=1 RETURN;\n  ENDPROC\nENDMODULE\n";

void procedures_of_the_module_are_followed_where_they_are_called() {
  const Program program = rapid_program("m.mod", kPaths);
  TEST_ASSERT_EQUAL(3, program.motions.size());
  TEST_ASSERT_EQUAL(16, program.motions[0].line);
  assert_at(100, 0, 50, program.motions[0].end.position);
  assert_at(90, 22, 52.5, program.motions[1].end.position);
  TEST_ASSERT_EQUAL(12, program.motions[1].line);
  assert_at(20, 0, 0, program.motions[2].end.position);
}

/// The module has its only routine's name, and no main.
void a_module_without_main_begins_at_the_routine_that_moves() {
  std::string text = kPaths;
  text.replace(text.find("Module1"), 7, "Path_20");
  text.replace(text.find("PROC main()\n    Path_20;"), 24, "PROC job()\n    Path_20; ");
  TEST_ASSERT_EQUAL(16, rapid_program("m.mod", text).motions[0].line);
}

void a_number_that_the_module_changes_is_no_constant() {
  std::string text = kPaths;
  text.replace(text.find("    Path_20;\n"), 13, "    Incr dx;\n");
  const std::string told = refusal(text);
  TEST_ASSERT_TRUE(told.find("m.mod:12: the point is not one that this module tells") == 0);
}

/// By hand: half a turn about y, then 90° about the tool's z: x goes to y, y to x, z to -z.
void rel_tool_turns_about_the_tools_axes() {
  const std::string start =
      "MODULE m\nCONST robtarget p:=[[1,2,3],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "PROC main()\nMoveJ p,v100,fine,t;\nMoveL RelTool(p,0,0,-10";
  const Program about_z = rapid_program("m.mod", start + "\\Rz:=90),v100,fine,t;\nENDPROC\n");
  assert_at(1, 2, 13, about_z.motions[1].end.position);
  flexcomp::Matrix3<double> expected;
  expected << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (about_z.motions[1].end.rotation - expected).norm());
  // About x by 90° first, then about the new y by 90°, in whatever order they stand.
  const Program both = rapid_program("m.mod", start + "\\Ry:=90\\Rx:=90),v100,fine,t;\nENDPROC\n");
  flexcomp::Matrix3<double> half;
  half << -1, 0, 0, 0, 1, 0, 0, 0, -1;
  flexcomp::Matrix3<double> x_then_y;
  x_then_y << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0, (both.motions[1].end.rotation - half * x_then_y).norm());
}

void a_time_is_a_feed_over_the_way_and_vel_set_bounds_it() {
  const Program program = rapid_program(
      "m.mod",
      "MODULE m\nCONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "PROC main()\nMoveJ p,v100,fine,t;\nMoveL Offs(p,30,40,0),v100\\T:=5,fine,t;\n"
      "MoveC Offs(p,40,50,0),Offs(p,30,60,0),v100\\T:=2,fine,t;\nVelSet 50,30;\n"
      "MoveL p,v100,fine,t;\nMoveL Offs(p,1,0,0),v20,fine,t;\nENDPROC\nENDMODULE\n");
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.01, program.motions[1].feed);  // 50 mm in 5 s
  TEST_ASSERT_DOUBLE_WITHIN(1e-9, M_PI * 0.01 / 2,
                            program.motions[2].feed);  // half of 20 π mm in 2 s
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.03, program.motions[3].feed);
  TEST_ASSERT_DOUBLE_WITHIN(1e-12, 0.01, program.motions[4].feed);
}

void what_stands_behind_return_is_not_run() {
  const Program program = rapid_program(
      "m.mod",
      "MODULE m\nCONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "PROC main()\ncut;\nMoveL p,v100,fine,t;\nEXIT;\nMoveL p,v100,fine,t;\nENDPROC\n"
      "PROC cut()\nMoveJ Offs(p,1,0,0),v100,fine,t;\nRETURN;\nMoveL p,v100,fine,t;\nENDPROC\n");
  TEST_ASSERT_EQUAL(2, program.motions.size());
  TEST_ASSERT_EQUAL(10, program.motions[0].line);
  TEST_ASSERT_EQUAL(5, program.motions[1].line);
  TEST_ASSERT_EQUAL(1, program.notes.size());
  TEST_ASSERT_EQUAL(12, program.notes[0].line);
}

CorrectedProgram corrected(const Program& source) {
  CorrectedProgram program;
  program.source = source;
  program.frame = source.frame.value_or(Pose<double>{});
  for (Motion motion : source.motions) {
    motion.end.position.z() += 1e-4;
    program.in_place.push_back({motion});
  }
  return program;
}

void a_module_keeps_all_that_does_not_move() {
  const Program source = rapid_program("sign.mod", kModule);
  const std::string text = text_of(corrected(source), Format::rapid, "sign");
  std::string expected = kModule;
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = expected.find(from);
    TEST_ASSERT_TRUE(at != std::string::npos);
    expected.replace(at, from.size(), to);
  };
  const std::string rest =
      ",[0.000000000,0.000000000,1.000000000,0.000000000],[0,-1,0,1],[9E9,9E9,9E9,9E9,9E9,9E9]]";
  replace("Offs (pMid,50,0,20), v1000, z10", "[[60.0000,20.0000,50.1000]" + rest + ", v1000, z10");
  replace("Offs(pMid,50,0,0),\n      v100", "[[60.0000,20.0000,30.1000]" + rest + ",       v100");
  const std::size_t circle = expected.find("MoveC");
  TEST_ASSERT_EQUAL_STRING(expected.substr(0, circle).c_str(),
                           text.substr(0, text.find("MoveC")).c_str());
  TEST_ASSERT_TRUE(text.find(rest + ",v200\\V:=150,z5,tPen\\WObj:=wTable;\n    TPWrite") !=
                   std::string::npos);
}

void a_target_in_brackets_keeps_its_configuration_and_axes() {
  const Program source =
      rapid_program("m.mod",
                    "MODULE m\nPROC main()\nMoveL "
                    "[[1,2,3],[1,0,0,0],[1,-1,2,0],[7,9E9,9E9,9E9,9E9,9E9]],v100,fine,"
                    "tool0;\nENDPROC\nENDMODULE\n");
  CorrectedProgram program;
  program.source = source;
  program.in_place.push_back({source.motions[0]});
  TEST_ASSERT_TRUE(text_of(program, Format::rapid, "m")
                       .find(",[1,-1,2,0],[7,9E9,9E9,9E9,9E9,9E9]],v100,fine,tool0;") !=
                   std::string::npos);
}

void procedures_are_written_where_they_stand() {
  const std::string text = text_of(corrected(rapid_program("m.mod", kPaths)), Format::rapid, "m");
  const std::size_t first = text.find("PROC Path_10()\n    MoveL [[90.0000,22.0000,52.6000],");
  const std::size_t second = text.find("    MoveL [[20.0000,0.0000,0.1000],[");
  const std::size_t third = text.find("PROC Path_20()\n    MoveJ [[100.0000,0.0000,50.1000],");
  TEST_ASSERT_TRUE(first < second && second < third && third != std::string::npos);
  const std::string element = ",[0,1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,t;\n";
  TEST_ASSERT_TRUE(text.find(element, second) < third);
}

/// Two parts, of 15 and 45 mm: a quarter and three quarters of eight seconds.
void parts_of_a_motion_share_its_time() {
  CorrectedProgram program;
  program.source = rapid_program(
      "m.mod",
      "MODULE m\nCONST robtarget p:=[[0,0,0],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n"
      "PROC main()\nMoveJ p,v100,fine,t;\nMoveL Offs(p,60,0,0),v100\\T:=8,z1,t;\nENDPROC\n");
  Motion part = program.source.motions[1];
  part.end.position.x() = 0.015;
  program.in_place = {{program.source.motions[0]}, {part, program.source.motions[1]}};
  const std::string text = text_of(program, Format::rapid, "m");
  TEST_ASSERT_TRUE(text.find("9E9]],v100\\T:=2,z0,t;\n") != std::string::npos);
  TEST_ASSERT_TRUE(text.find("9E9]],v100\\T:=6,z1,t;\n") != std::string::npos);
}

/// tool0 would be the bare flange, and every controller has it.
void a_new_module_needs_a_tool_that_somebody_declares() {
  CorrectedProgram program = corrected(rapid_program("sign.mod", kModule));
  program.source.format = Format::gcode;
  CarriedTool tool;
  tool.tcp.position = {0, 0, 0.25};
  tool.mass = 12;
  tool.center = {0, 0, 0.1};
  program.tool = tool;
  const std::string text = text_of(program, Format::rapid, "sign");
  TEST_ASSERT_TRUE(text.find(",tool0") == std::string::npos);
  TEST_ASSERT_TRUE(text.find(",sign_tool\\WObj:=sign_work;\n") != std::string::npos);
  TEST_ASSERT_TRUE(text.find("\n! PERS tooldata sign_tool:=[TRUE,[[0.0000,0.0000,250.0000],"
                             "[1.000000000,0.000000000,0.000000000,0.000000000]],"
                             "[12,[0.0000,0.0000,100.0000],[1,0,0,0],0,0,0]];\n") !=
                   std::string::npos);
}

void what_is_written_is_read_back() {
  const CorrectedProgram program = corrected(rapid_program("sign.mod", kModule));
  CorrectedProgram anew = program;
  anew.source.format = Format::gcode;  // as of another format: a module of its own
  for (const CorrectedProgram& each : {program, anew}) {
    const Program again = rapid_program("again.mod", text_of(each, Format::rapid, "again"));
    TEST_ASSERT_EQUAL(4, again.motions.size());
    for (std::size_t i = 0; i < 4; ++i) {
      const Pose<double>& end = program.in_place[i].front().end;
      TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0, (again.motions[i].end.position - end.position).norm());
      TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0, (again.motions[i].end.rotation - end.rotation).norm());
      TEST_ASSERT_TRUE(again.motions[i].kind == program.in_place[i].front().kind);
    }
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0, (again.frame->position - program.frame.position).norm());
    TEST_ASSERT_DOUBLE_WITHIN(1e-7, 0, (again.frame->rotation - program.frame.rotation).norm());
  }
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(targets_are_found_wherever_they_are_declared);
  RUN_TEST(the_work_object_is_user_frame_times_object_frame);
  RUN_TEST(what_cannot_be_told_is_refused_with_its_line);
  RUN_TEST(a_module_keeps_all_that_does_not_move);
  RUN_TEST(a_target_in_brackets_keeps_its_configuration_and_axes);
  RUN_TEST(what_changes_the_way_and_is_not_read_is_refused_with_its_line);
  RUN_TEST(procedures_of_the_module_are_followed_where_they_are_called);
  RUN_TEST(a_module_without_main_begins_at_the_routine_that_moves);
  RUN_TEST(a_number_that_the_module_changes_is_no_constant);
  RUN_TEST(rel_tool_turns_about_the_tools_axes);
  RUN_TEST(a_time_is_a_feed_over_the_way_and_vel_set_bounds_it);
  RUN_TEST(what_stands_behind_return_is_not_run);
  RUN_TEST(procedures_are_written_where_they_stand);
  RUN_TEST(parts_of_a_motion_share_its_time);
  RUN_TEST(a_new_module_needs_a_tool_that_somebody_declares);
  RUN_TEST(what_is_written_is_read_back);
  return UNITY_END();
}
