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
  TEST_ASSERT_EQUAL(1, program.notes.size());
  TEST_ASSERT_EQUAL(12, program.notes[0].line);
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
  RUN_TEST(what_is_written_is_read_back);
  return UNITY_END();
}
