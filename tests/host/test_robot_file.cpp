#include <fcntl.h>
#include <unistd.h>

#include <functional>
#include <string>

#include "error.hpp"
#include "host/arm_robot.hpp"
#include "model/robot.hpp"
#include "unity_main.hpp"

using flexcomp::InputError;
using flexcomp::model::load_robot;
using flexcomp::test::content_of;
using flexcomp::test::Edit;
using flexcomp::test::put;
using flexcomp::test::put_arm;
using flexcomp::test::ScratchFolder;
namespace fs = std::filesystem;

namespace {

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

/// The message with the folder cut off, which is where each has to begin.
std::string load_refusal(const ScratchFolder& folder, const std::string& file = "robot.yaml") {
  const std::string message = refusal([&] { load_robot(folder / file); });
  const std::string start = (folder / "").string();
  return message.rfind(start, 0) == 0 ? message.substr(start.size()) : message;
}

struct Refusal {
  Edit edit;
  std::string message;
};

void a_yaml_file_that_is_wrong_is_refused_with_its_line_and_key() {
  const std::string other_keys =
      "compliance, viscous, coulomb, rotor_inertia, backlash, cubic_compliance, link_compliance";
  const Refusal refusals[] = {
      {{"schema: flexcomp/robot/1\n", ""}, "robot.yaml:1: 'schema': missing"},
      {{"robot/1", "robot/2"},
       "robot.yaml:1: 'schema': expected flexcomp/robot/1, found flexcomp/robot/2"},
      {{"name: An arm\n", ""}, "robot.yaml:1: 'name': missing"},
      {{"An arm", "[An, arm]"}, "robot.yaml:2: 'name': expected a text, found a list of 2"},
      {{"An arm", ""}, "robot.yaml:2: 'name': expected a text, found nothing"},
      {{"An arm", "[An"}, "robot.yaml:3: not valid YAML: "},
      {{"An arm", "An\tarm: \"\\q\""}, "robot.yaml:2: not valid YAML: "},
      {{"payload:", "---\npayload:"},
       "robot.yaml: expected one YAML document and nothing after it"},
      {{"schema:", ",schema:"}, "robot.yaml: expected one YAML document and nothing after it"},
      {{"name:", "nmae:"}, "robot.yaml:2: 'nmae': unknown key; did you mean 'name'?"},
      {{"name:", "title:"}, "robot.yaml:2: 'title': unknown key; expected one of: schema, name, "},
      {{"name:", "urdf: x\nname:"}, "robot.yaml:4: 'urdf': the key appears twice"},
      {{"name:", "[a, b]: 1\nname:"}, "robot.yaml:2: expected a word as key, found a list of 2"},
      {{"arm.urdf", "leg.urdf"}, "robot.yaml:3: 'urdf': no such file: "},
      {{"gravity: [0, 0, -9.81]\n", ""}, "robot.yaml:1: 'gravity': missing"},
      {{"-9.81]", "-9.81, 0]"},
       "robot.yaml:6: 'gravity': expected a list of 3 numbers, found a list of 4"},
      {{"-9.81]", ".nan]"}, "robot.yaml:6: 'gravity': expected a finite number, found '.nan'"},
      {{"-9.81]", "down]"}, "robot.yaml:6: 'gravity': expected a finite number, found 'down'"},
      {{"joints:", "joints: 6\npayload:"}, "robot.yaml:15: 'payload': the key appears twice"},
      {{"  j3: {compliance: 3e-6}\n", ""}, "robot.yaml:8: 'joints.j3': missing"},
      {{"  j3:", "  j7:"},
       "robot.yaml:10: 'joints.j7': no revolute joint between 'base' and 'tool' has this name; "
       "expected one of: j1, j2, j3, j4, j5, j6"},
      {{"  j3:", "  slide: {compliance: 0}\n  j3:"},
       "robot.yaml:10: 'joints.slide': no revolute joint between 'base' and 'tool' has this name"},
      {{"{compliance: 3e-6}", "3e-6"},
       "robot.yaml:10: 'joints.j3': expected keys and values, found '3e-6'"},
      {{"{compliance: 3e-6}", "{}"}, "robot.yaml:10: 'joints.j3.compliance': missing"},
      {{"{compliance: 3e-6}", "{stiffness: 3e6}"},
       "robot.yaml:10: 'joints.j3.stiffness': unknown key; expected one of: " + other_keys},
      {{"{compliance: 3e-6}", "{complaince: 3e-6}"},
       "robot.yaml:10: 'joints.j3.complaince': unknown key; did you mean 'compliance'?"},
      {{"3e-6", "-3e-6"},
       "robot.yaml:10: 'joints.j3.compliance': must not be negative, found -3e-06"},
      {{"3e-6", ".inf"},
       "robot.yaml:10: 'joints.j3.compliance': expected a finite number, found '.inf'"},
      {{"3e-6", "1e999"},
       "robot.yaml:10: 'joints.j3.compliance': expected a finite number, found '1e999'"},
      {{"3e-6", "3e-6 m"}, "robot.yaml:10: 'joints.j3.compliance': expected a finite number"},
      {{"3e-6", "3e-6, viscous: -1"}, "robot.yaml:10: 'joints.j3.viscous': must not be negative"},
      {{"3e-6", "3e-6, coulomb: -1"}, "robot.yaml:10: 'joints.j3.coulomb': must not be negative"},
      {{"3e-6", "3e-6, rotor_inertia: -1"},
       "robot.yaml:10: 'joints.j3.rotor_inertia': must not be negative"},
      {{"3e-6", "3e-6, backlash: -1"}, "robot.yaml:10: 'joints.j3.backlash': must not be negative"},
      {{"3e-6", "3e-6, cubic_compliance: soft"},
       "robot.yaml:10: 'joints.j3.cubic_compliance': expected a finite number, found 'soft'"},
      {{"3e-6", "3e-6, link_compliance: [0, 0, 0, 0, 0, -1]"},
       "robot.yaml:10: 'joints.j3.link_compliance': a compliance must not be negative"},
      {{"payload:", "base_compliance: 0\npayload:"},
       "robot.yaml:14: 'base_compliance': expected a list of 6 numbers, found '0'"},
      {{"payload:", "tool_compliance: [1, 2, 3, 4, 5, -6]\npayload:"},
       "robot.yaml:14: 'tool_compliance': a compliance must not be negative"},
      {{"mass: 7", "mass: -7"}, "robot.yaml:14: 'payload.mass': must not be negative, found -7"},
      {{"mass: 7", "com: [0, 0, 0]"}, "robot.yaml:14: 'payload.mass': missing"},
      {{"mass: 7", "mass: 7, center: [0, 0, 0]"}, "robot.yaml:14: 'payload.center': unknown key"},
      {{"mass: 7", "mass: 7, com: [0, 0]"},
       "robot.yaml:14: 'payload.com': expected a list of 3 numbers, found a list of 2"},
      {{"payload: {mass: 7}", "\"pay\\nload\": {mass: 7}"},
       "robot.yaml:14: 'pay load': unknown key"},
  };
  const ScratchFolder folder;
  for (const Refusal& one : refusals) {
    put_arm(folder, one.edit);
    const std::string message = load_refusal(folder);
    TEST_ASSERT_EQUAL_STRING(one.message.c_str(), message.substr(0, one.message.size()).c_str());
    TEST_ASSERT_TRUE_MESSAGE(message.find('\n') == std::string::npos, message.c_str());
  }
}

void a_urdf_that_is_wrong_is_refused_with_the_link_or_joint() {
  const std::string limit = "<limit lower='-1' upper='1' effort='10' velocity='2'/>";
  const std::string expected = "expected six revolute joints between 'base' and 'tool'";
  const Refusal refusals[] = {
      {{"<link name='base'/>", "<link name='base'>"}, "arm.urdf:"},
      {{"<robot name='arm'>", "<robot>"},
       "arm.urdf: not a valid URDF: No name given for the robot."},
      {{"<link name='other'/>", "<link name='l1'/>"},
       "arm.urdf: not a valid URDF: link 'l1' is not unique."},
      {{"link='base'", "link='bases'"}, "arm.urdf: not a valid URDF: "},
      {{"'0.3 0.1 -0.2'", "'0.3 0.1'"}, "arm.urdf: not a valid URDF: "},
      {{"'0.3 0.1 -0.2'", "'0.3 nan -0.2'"}, "arm.urdf: not a valid URDF: "},
      {{"'0.1 0 0.1'", "'1e200 0 0.1'"}, "arm.urdf: a length or mass is too large to compute with"},
      {{limit, ""}, "arm.urdf: not a valid URDF: Joint [j1] is of type REVOLUTE"},
      {{"effort='10'", ""}, "arm.urdf: not a valid URDF: joint limit: no effort"},
      {{"lower='-1' upper='1'", ""},
       "arm.urdf: joint 'j1': expected limits with lower below upper"},
      {{"lower='-1'", "lower='1.5'"},
       "arm.urdf: joint 'j1': expected limits with lower below upper"},
      {{"velocity='2'", "velocity='-2'"},
       "arm.urdf: joint 'j1': the limits of effort and velocity must not be negative"},
      {{"'0.6 0 0.8'", "'0 0 0'"},
       "arm.urdf: joint 'j1': the axis has length 0; expected a unit vector"},
      {{"'0.6 0 0.8'", "'0 0 2'"},
       "arm.urdf: joint 'j1': the axis has length 2; expected a unit vector"},
      {{"'j1' type='revolute'", "'j1' type='continuous'"},
       "arm.urdf: joint 'j1': is continuous, so without limits; " + expected},
      {{"'j1' type='revolute'", "'j1' type='prismatic'"},
       "arm.urdf: joint 'j1': is prismatic; " + expected},
      {{"'j1' type='revolute'", "'j1' type='floating'"},
       "arm.urdf: joint 'j1': is floating; " + expected},
      {{"'j1' type='revolute'", "'j1' type='fixed'"}, "arm.urdf: " + expected + ", found 5"},
      {{"'plate' type='fixed'><parent link='l6'/>",
        "'plate' type='revolute'>" + limit + "<parent link='l6'/>"},
       "arm.urdf: " + expected + ", found 7"},
      {{limit, limit + "<mimic joint='j2'/>"},
       "arm.urdf: joint 'j1': mimics another; expected joints that move by themselves"},
      {{"<mass value='1'/>", "<mass value='-1'/>"},
       "arm.urdf: link 'l1': the mass must not be negative, found -1"},
      {{"<mass value='11'/>", "<mass value='-11'/>"},
       "arm.urdf: link 'bracket': the mass must not be negative, found -11"},
      {{"ixx='1'", "ixx='-1'"},
       "arm.urdf: link 'l1': no body has this inertia: a principal moment is negative"},
      {{"link='flange'/><child link='tool'/>", "link='base'/><child link='tool'/>"},
       "arm.urdf: " + expected + ", found 0"},
  };
  const ScratchFolder folder;
  for (const Refusal& one : refusals) {
    put_arm(folder, {}, one.edit);
    const std::string message = load_refusal(folder);
    TEST_ASSERT_EQUAL_STRING(one.message.c_str(), message.substr(0, one.message.size()).c_str());
    TEST_ASSERT_TRUE_MESSAGE(message.find('\n') == std::string::npos, message.c_str());
  }
}

void a_file_that_is_none_is_refused() {
  const ScratchFolder folder;
  TEST_ASSERT_EQUAL_STRING("robot.yaml: no such file", load_refusal(folder).c_str());
  fs::create_directory(folder / "folder");
  TEST_ASSERT_EQUAL_STRING("folder: is a directory; expected a file",
                           load_refusal(folder, "folder").c_str());
  put(folder / "robot.yaml", "");
  TEST_ASSERT_EQUAL_STRING("robot.yaml: the file is empty", load_refusal(folder).c_str());
  put(folder / "robot.yaml", std::string("\x7f"
                                         "ELF\0\1",
                                         6));
  TEST_ASSERT_EQUAL_STRING("robot.yaml: not a text file", load_refusal(folder).c_str());
  put(folder / "robot.yaml", "only words\n");
  TEST_ASSERT_EQUAL_STRING("robot.yaml:1: expected keys and values, found 'only words'",
                           load_refusal(folder).c_str());
  put(folder / "robot.yaml", std::string(100000, '['));
  TEST_ASSERT_EQUAL_STRING("robot.yaml:1: not valid YAML: ",
                           load_refusal(folder).substr(0, 30).c_str());
}

void a_urdf_that_is_no_urdf_is_refused() {
  const ScratchFolder folder;
  put_arm(folder, {"arm.urdf", "."});
  TEST_ASSERT_EQUAL_STRING(".: is a directory; expected a file", load_refusal(folder).c_str());
  put_arm(folder);
  put(folder / "arm.urdf", "");
  TEST_ASSERT_EQUAL_STRING("arm.urdf: the file is empty", load_refusal(folder).c_str());
  put(folder / "arm.urdf", "solid cube\n");
  TEST_ASSERT_EQUAL_STRING("arm.urdf:", load_refusal(folder).substr(0, 9).c_str());
  put(folder / "arm.urdf", "<robot name='arm'>\n<link name='base'/>\n<link></robot>\n");
  TEST_ASSERT_EQUAL_STRING("arm.urdf:3: not valid XML: ",
                           load_refusal(folder).substr(0, 27).c_str());
  std::string nested;
  for (int i = 0; i < 100000; ++i) {
    nested += "<a>";
  }
  put(folder / "arm.urdf", nested);
  TEST_ASSERT_EQUAL_STRING("arm.urdf: expected at most 10000 XML elements",
                           load_refusal(folder).c_str());
}

/// urdfdom takes both for trees.
void links_that_form_a_loop_or_have_two_parents_are_refused() {
  const ScratchFolder folder;
  const std::string link = "<link name='other'/>";
  put_arm(
      folder, {"base_link: base", "base_link: a"},
      {link, link + "<link name='a'/><link name='b'/>"
                    "<joint name='ab' type='fixed'><parent link='a'/><child link='b'/></joint>"
                    "<joint name='ba' type='fixed'><parent link='b'/><child link='a'/></joint>"});
  TEST_ASSERT_EQUAL_STRING("arm.urdf: not a valid URDF: its links form a loop",
                           load_refusal(folder).c_str());
  put_arm(folder, {},
          {link, link + "<joint name='again' type='fixed'><parent link='base'/>"
                        "<child link='l3'/></joint>"});
  TEST_ASSERT_EQUAL_STRING("arm.urdf: not a valid URDF: link 'l3' is the child of two joints",
                           load_refusal(folder).c_str());
}

/// A name may hold a line end, but a complaint is one line.
void names_of_two_lines_are_named_in_one() {
  const ScratchFolder folder;
  const std::string link = "<link name='other'/>";
  put_arm(folder, {"base_link: base", "base_link: \"ba\\nse\""},
          {link, link + "<link name='ba&#10;se'/><joint name='more' type='fixed'>"
                        "<parent link='base'/><child link='ba&#10;se'/></joint>"});
  const std::string message = load_refusal(folder);
  TEST_ASSERT_TRUE_MESSAGE(message.find("'ba se'") != std::string::npos, message.c_str());
  TEST_ASSERT_TRUE_MESSAGE(message.find('\n') == std::string::npos, message.c_str());
}

void links_that_are_not_there_are_named() {
  const ScratchFolder folder;
  put_arm(folder, {"base_link: base", "base_link: bass"});
  TEST_ASSERT_EQUAL_STRING("arm.urdf: has no link 'bass'", load_refusal(folder).c_str());
  put_arm(folder, {"tool_link: tool", "tool_link: tol"});
  TEST_ASSERT_EQUAL_STRING("arm.urdf: has no link 'tol'", load_refusal(folder).c_str());
  put_arm(folder, {"tool_link: tool", "tool_link: other"});
  TEST_ASSERT_EQUAL_STRING(
      "arm.urdf: expected six revolute joints between 'base' and 'other', found 0",
      load_refusal(folder).c_str());
  put_arm(folder, {"base_link: base", "base_link: other"});
  TEST_ASSERT_EQUAL_STRING("arm.urdf: link 'tool' does not lie beyond link 'other'",
                           load_refusal(folder).c_str());
}

/// Standard error goes to a file for as long as it lives.
class StandardError {
 public:
  explicit StandardError(const fs::path& file)
      : kept_(::dup(STDERR_FILENO)),
        file_(::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600)) {
    ::dup2(file_, STDERR_FILENO);
  }
  StandardError(const StandardError&) = delete;
  StandardError& operator=(const StandardError&) = delete;
  ~StandardError() {
    ::dup2(kept_, STDERR_FILENO);
    ::close(kept_);
    ::close(file_);
  }

 private:
  int kept_;
  int file_;
};

void the_urdf_parser_prints_nothing_of_its_own() {
  const ScratchFolder folder;
  put_arm(folder, {}, {"'0.3 0.1 -0.2'", "'0.3 0.1'"});
  {
    const StandardError to_file(folder / "stderr");
    load_refusal(folder);
  }
  TEST_ASSERT_EQUAL_STRING("", content_of(folder / "stderr").c_str());
}

}  // namespace

int main() {
  UNITY_BEGIN();
  RUN_TEST(a_yaml_file_that_is_wrong_is_refused_with_its_line_and_key);
  RUN_TEST(a_urdf_that_is_wrong_is_refused_with_the_link_or_joint);
  RUN_TEST(a_file_that_is_none_is_refused);
  RUN_TEST(a_urdf_that_is_no_urdf_is_refused);
  RUN_TEST(links_that_form_a_loop_or_have_two_parents_are_refused);
  RUN_TEST(names_of_two_lines_are_named_in_one);
  RUN_TEST(links_that_are_not_there_are_named);
  RUN_TEST(the_urdf_parser_prints_nothing_of_its_own);
  return UNITY_END();
}
