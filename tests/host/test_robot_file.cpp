#include <fcntl.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "host/arm_robot.hpp"
#include "model/robot.hpp"
#include "refusal.hpp"
#include "unity_main.hpp"

using flexcomp::model::load_robot;
using flexcomp::test::content_of;
using flexcomp::test::Edit;
using flexcomp::test::put;
using flexcomp::test::put_arm;
using flexcomp::test::refusal_of;
using flexcomp::test::ScratchFolder;
namespace fs = std::filesystem;

namespace {

/// The message with the folder cut off, which is where each has to begin.
std::string load_refusal(const ScratchFolder& folder, const std::string& file = "robot.yaml") {
  const std::string message = refusal_of([&] { load_robot(folder / file); });
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
      {{"An arm", "\"An\\narm\""},
       "robot.yaml:2: 'name': expected one line of UTF-8 without control characters"},
      {{"An arm", "\"An \\e[2Jarm\""}, "robot.yaml:2: 'name': expected one line of UTF-8"},
      {{"An arm", "[An"}, "robot.yaml:3: not valid YAML: "},
      {{"An arm", "An\tarm: \"\\q\""}, "robot.yaml:2: not valid YAML: "},
      {{"payload:", "---\npayload:"},
       "robot.yaml: expected one YAML document and nothing after it"},
      {{"schema:", ",schema:"}, "robot.yaml: expected one YAML document and nothing after it"},
      {{"name:", "nmae:"}, "robot.yaml:2: 'nmae': unknown key; did you mean 'name'?"},
      {{"name:", "title:"}, "robot.yaml:2: 'title': unknown key; expected one of: schema, name, "},
      {{"name:", "tool: {mass: 3}\nname:"}, "robot.yaml:2: 'tool.xyz': missing"},
      {{"name:", "tool: {xyz: [0, 0, 1], lenght: 3}\nname:"},
       "robot.yaml:2: 'tool.lenght': unknown key; expected one of: xyz, rpy, mass, com, inertia"},
      {{"name:", "tool: {xyz: [0, 0, 1], mass: -3}\nname:"}, "robot.yaml:2: 'tool.mass': "},
      {{"name:", "tool: {xyz: [0, 0, 1], mass: 3, inertia: [1, 0, 0, 1, 0, 3]}\nname:"},
       "robot.yaml:2: 'tool.inertia': no body has this inertia; expected ixx, ixy, ixz, iyy, iyz, "
       "izz"},
      {{"name:", "tool: {xyz: [0, 0, 1], com: [0, 0, 1]}\nname:"},
       "robot.yaml:2: 'tool.com': a tool without mass has none"},
      {{"name:", "urdf: x\nname:"}, "robot.yaml:4: 'urdf': the key appears twice"},
      {{"name:", "[a, b]: 1\nname:"}, "robot.yaml:2: expected a word as key, found a list of 2"},
      {{"arm.urdf", "leg.urdf"}, "robot.yaml:3: 'urdf': no such file: "},
      {{"name:", "transmission: [1, 0]\nname:"},
       "robot.yaml:2: 'transmission': expected a list of 6 rows, found a list of 2"},
      {{"name:", "transmission: [[1], [1], [1], [1], [1], [1]]\nname:"},
       "robot.yaml:2: 'transmission': expected rows of 6 numbers, found a list of 1"},
      {{"name:",
        "transmission: [[1, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0], [0, 0, 1, 0, 0, 0], [0, 0, 0, 1, "
        "0, 0],"
        " [0, 0, 0, 0, 1, 1], [0, 0, 0, 0, 1, 1]]\nname:"},
       "robot.yaml:2: 'transmission': the motors must tell the joints' angles"},
      {{"name:", "reference_temperature: -300\nname:"},
       "robot.yaml:2: 'reference_temperature': expected °C; nothing is colder than -273.15"},
      {{"gravity: [0, 0, -9.81]\n", ""}, "robot.yaml:1: 'gravity': missing"},
      {{"-9.81]", "-9.81, 0]"},
       "robot.yaml:6: 'gravity': expected a list of 3 numbers, found a list of 4"},
      {{"-9.81]", ".nan]"}, "robot.yaml:6: 'gravity': expected a finite number, found '.nan'"},
      {{"-9.81]", "down]"}, "robot.yaml:6: 'gravity': expected a finite number, found 'down'"},
      {{"joints:", "joints: 6\npayload:"}, "robot.yaml:15: 'payload': the key appears twice"},
      {{"  j3: {compliance: 3e-6}\n", ""}, "robot.yaml:8: 'joints.j3': missing"},
      {{"  j3:", "  j7:"},
       "robot.yaml:10: 'joints.j7': no joint that moves between 'base' and 'tool' has this name; "
       "expected one of: j1, j2, j3, j4, j5, j6"},
      {{"  j3:", "  slide: {compliance: 0}\n  j3:"},
       "robot.yaml:10: 'joints.slide': no joint that moves between 'base' and 'tool' has this "
       "name"},
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
      {{"3e-6", "0.5"},
       "robot.yaml:10: 'joints.j3.compliance': 0.5 rad/(N·m) is softer than any robot; expected "
       "0.1 rad/(N·m) at most"},
      {{"3e-6", "2e6"},
       "robot.yaml:10: 'joints.j3.compliance': 2e+06 rad/(N·m) is softer than any robot"},
      {{"3e-6", "3e-6, cubic_compliance: -2"},
       "robot.yaml:10: 'joints.j3.cubic_compliance': -2 rad/(N·m)³ is softer than any robot"},
      {{"3e-6", "3e-6, link_compliance: [0, 0, 0.1, 0, 0, 0]"},
       "robot.yaml:10: 'joints.j3.link_compliance': 0.1 m/N is softer than any robot; expected "
       "0.01 m/N at most"},
      {{"payload:", "base_compliance: [0, 0, 0, 1, 0, 0]\npayload:"},
       "robot.yaml:14: 'base_compliance': 1 rad/(N·m) is softer than any robot"},
      {{"payload:", "tool_compliance: [1e-3, 0.02, 0, 0, 0, 0]\npayload:"},
       "robot.yaml:14: 'tool_compliance': 0.02 m/N is softer than any robot"},
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

void springs_of_a_desktop_arm_and_softer_are_read() {
  const ScratchFolder folder;
  for (const char* compliance : {"0", "1e-12", "1e-4", "1e-2", "0.05"}) {
    put_arm(folder, {"3e-6", compliance});
    TEST_ASSERT_EQUAL_STRING("accepted", load_refusal(folder).c_str());
  }
}

void a_urdf_that_is_wrong_is_refused_with_the_link_or_joint() {
  const std::string limit = "<limit lower='-1' upper='1' effort='10' velocity='2'/>";
  const std::string expected =
      "expected 1 to 12 revolute, continuous or prismatic joints between 'base' and 'tool'";
  const Refusal refusals[] = {
      {{"<link name='base'/>", "<link name='base'>"}, "arm.urdf:"},
      {{"<robot name='arm'>", "<robot>"},
       "arm.urdf: not a valid URDF: No name given for the robot."},
      {{"<link name='other'/>", "<link name='l1'/>"},
       "arm.urdf: not a valid URDF: link 'l1' is not unique."},
      {{"link='base'", "link='bases'"}, "arm.urdf: not a valid URDF: "},
      {{"'0.1 0 0.1'", "'1e200 0 0.1'"}, "arm.urdf: a length or mass is too large to compute with"},
      {{"lower='-1'", "lower='1.5'"},
       "arm.urdf: joint 'j1': expected limits with lower below upper"},
      {{"velocity='2'", "velocity='-2'"},
       "arm.urdf: joint 'j1': the limits of effort and velocity must not be negative"},
      {{"'0.6 0 0.8'", "'0 0 0'"},
       "arm.urdf: joint 'j1': the axis has length 0; expected a unit vector"},
      {{"'0.6 0 0.8'", "'0 0 2'"},
       "arm.urdf: joint 'j1': the axis has length 2; expected a unit vector"},
      {{"'j1' type='revolute'", "'j1' type='floating'"},
       "arm.urdf: joint 'j1': is floating; " + expected},
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

void more_joints_than_there_is_room_for_are_refused() {
  std::string more;
  std::string parent = "flange";
  for (int number = 7; number <= 13; ++number) {
    const std::string link = "more" + std::to_string(number);
    more += "<joint name='" + link + "' type='continuous'><axis xyz='0 0 1'/><parent link='" +
            parent + "'/><child link='" + link + "'/></joint><link name='" + link + "'/>";
    parent = link;
  }
  const ScratchFolder folder;
  put_arm(folder, {},
          {"<joint name='holder' type='fixed'><parent link='flange'/>",
           more + "<joint name='holder' type='fixed'><parent link='" + parent + "'/>"});
  TEST_ASSERT_EQUAL_STRING(
      "arm.urdf: expected 1 to 12 revolute, continuous or prismatic joints between 'base' and "
      "'tool', found 13",
      load_refusal(folder).c_str());
}

/// What a command that needs the core says of the arm with a joint of another type, or without it.
void the_core_is_given_six_revolute_joints_only() {
  const std::string expected = "expected six revolute joints between 'base' and 'tool'";
  const Refusal refusals[] = {
      {{"", ""}, "accepted"},
      {{"'j1' type='revolute'", "'j1' type='continuous'"},
       "arm.urdf: joint 'j1': is continuous, so without limits; " + expected},
      {{"'j3' type='revolute'", "'j3' type='prismatic'"},
       "arm.urdf: joint 'j3': is prismatic; " + expected},
      {{"'j1' type='revolute'", "'j1' type='fixed'"}, "arm.urdf: " + expected + ", found 5"},
  };
  const ScratchFolder folder;
  for (const Refusal& one : refusals) {
    const bool has_five = one.edit.to.find("fixed") != std::string::npos;
    put_arm(folder, has_five ? Edit{"  j1: {compliance: 1e-6}\n", ""} : Edit{}, one.edit);
    const flexcomp::model::Robot robot = load_robot(folder / "robot.yaml");
    const std::string message = refusal_of([&] { six_axis_model(robot); });
    const std::string start = (folder / "").string();
    TEST_ASSERT_EQUAL_STRING(
        one.message.c_str(),
        (message.rfind(start, 0) == 0 ? message.substr(start.size()) : message).c_str());
  }
}

/// urdfdom reads zero, or leaves out the whole element, for each of these.
void a_urdf_value_that_cannot_be_read_is_refused_with_its_line() {
  const std::string mass = "<mass value='1'/>";
  const std::string inertia = "<inertia ixx='1' iyy='2' izz='2.5' ixy='0.1' ixz='0' iyz='0.2'/>";
  const std::string limit = "<limit lower='-1' upper='1' effort='10' velocity='2'/>";
  const std::string in_link = "arm.urdf:6: link 'l1': ";
  const std::string in_joint = "arm.urdf:4: joint 'j1': ";
  const auto no_number = [](const std::string& where, const std::string& found) {
    return where + ": expected a finite number, found '" + found + "'";
  };
  std::vector<Refusal> refusals = {
      {{mass, ""}, in_link + "<inertial>: <mass> is missing"},
      {{mass, "<mass/>"}, in_link + "<mass>: 'value' is missing"},
      {{mass, "<mass>1</mass>"}, in_link + "<mass>: 'value' is missing"},
      {{mass, "<mas value='1'/>"}, in_link + "<mas>: unknown in an <inertial>; expected <origin>"},
      {{mass, "<mass valve='1'/>"}, in_link + "<mass>: 'valve' is unknown; expected value"},
      {{mass, mass + "<mass value='2'/>"}, in_link + "<mass>: appears twice"},
      {{inertia, ""}, in_link + "<inertial>: <inertia> is missing"},
      {{"ixx='1' ", ""}, "arm.urdf:7: link 'l1': <inertia>: 'ixx' is missing"},
      {{"ixx='1' ", "ixx='1' iyx='0' "},
       "arm.urdf:7: link 'l1': <inertia>: 'iyx' is unknown; expected ixx, "},
      {{"</inertial>", "</inertial><inertial/>"},
       "arm.urdf:7: link 'l1': <inertial>: appears twice"},
      {{"<inertial>", "<inertail>"}, "arm.urdf:7: not valid XML"},
      {{"<link name='base'/>", "<link name='base'><inertail/></link>"},
       "arm.urdf:2: link 'base': <inertail>: 'inertail' is unknown; did you mean 'inertial'?"},
      {{"<link name='base'/>", "<link name='base'><mass value='1'/></link>"},
       "arm.urdf:2: link 'base': <mass>: does not belong into a <link>"},
      {{"<link name='base'/>", "<link name='base'/><inertial/>"},
       "arm.urdf:2: <inertial>: does not belong here; expected it in a link or joint"},
      {{"<axis xyz='0.6 0 0.8'/>", ""}, "arm.urdf:3: joint 'j1': <axis> is missing"},
      {{"<axis xyz='0.6 0 0.8'/>", "<axis/>"}, in_joint + "<axis>: 'xyz' is missing"},
      {{"<axis xyz=", "<axis rpy='0 0 0' xyz="}, in_joint + "<axis>: 'rpy' is unknown"},
      {{"<axis", "<axis xyz='1 0 0'/><axis"}, in_joint + "<axis>: appears twice"},
      {{"<axis", "<axes"}, in_joint + "<axes>: 'axes' is unknown; did you mean 'axis'?"},
      {{"<axis", "<mass value='1'/><axis"}, in_joint + "<mass>: does not belong into a <joint>"},
      {{limit, ""}, "arm.urdf:3: joint 'j1': <limit> is missing"},
      {{"lower='-1' ", "Lower='-1' "}, "arm.urdf:5: joint 'j1': <limit>: 'Lower' is unknown; did "},
      {{"<origin xyz=", "<origin quat_xyzw='0 0 0 1' xyz="},
       in_joint + "<origin>: 'quat_xyzw' is unknown; expected xyz, rpy"},
      {{"<origin xyz='0.3", "<Origin xyz='0.3"},
       in_joint + "<Origin>: 'Origin' is unknown; did you mean 'origin'?"},
      {{"<origin", "<origin/><origin"}, in_joint + "<origin>: appears twice"},
      {{"rpy='0.1 -0.4 1.1'", "rpy='0 -90 0'"},
       in_joint + "<origin>: rpy: expected radians, found -90, more than a whole turn; are these "},
      {{"</robot>", "</robot>\n<robot name='two'/>"}, "arm.urdf:50: <robot>: appears twice"},
      {{"<link name='base'/>", "<link name='base'/><xacro:include filename='a'/>"},
       "arm.urdf:2: xacro is left in it: '<xacro:include>'; expand it first: xacro "},
      {{"rpy='0.1 -0.4 1.1'", "rpy='0 ${pi / 2} 0'"},
       "arm.urdf:4: xacro is left in it: '0 ${pi / 2} 0'; expand it first: xacro "},
  };
  for (const char* name : {"lower", "upper", "effort", "velocity"}) {
    const std::string written = limit.substr(limit.find(name));
    const std::string attribute = written.substr(0, written.find('\'', written.find('\'') + 1) + 1);
    const std::string in_limit = std::string("arm.urdf:5: joint 'j1': <limit>: ");
    refusals.push_back({{attribute, ""}, in_limit + "'" + name + "' is missing"});
    refusals.push_back(
        {{attribute, std::string(name) + "='1,5'"}, no_number(in_limit + name, "1,5")});
  }
  const std::string in_inertia = "arm.urdf:7: link 'l1': <inertia>: ixx";
  for (const char* number : {"", " ", "1,5", "nan", "inf", "-inf", "1e999", "0x10", "1 kg", "1 ",
                             "1\t", "1.5.0", "one", "1e", "--1", "+-1", "1;5", "1'000", "1_000"}) {
    const std::string quoted = std::string("\"") + number + "\"";
    const std::string shown = number == std::string("1\t") ? "1 " : number;
    refusals.push_back(
        {{mass, "<mass value=" + quoted + "/>"}, no_number(in_link + "<mass>: value", shown)});
    refusals.push_back({{"ixx='1'", "ixx=" + quoted}, no_number(in_inertia, shown)});
  }
  for (const char* three :
       {"", "0.3 0.1", "0.3 0.1 -0.2 0", "0,3 0,1 -0,2", "0.3,0.1,-0.2", "0.3 nan -0.2",
        "0.3 0.1 inf", "0.3 0.1 1e999", "0.3\t0.1\t-0.2", "0.3 0.1 -0.2m", "0x1 0 0", "a b c"}) {
    const std::string quoted = std::string("\"") + three + "\"";
    const std::string expected = ": expected 3 finite numbers between spaces, found '";
    refusals.push_back({{"'0.3 0.1 -0.2'", quoted}, in_joint + "<origin>: xyz" + expected});
    refusals.push_back({{"'0.1 -0.4 1.1'", quoted}, in_joint + "<origin>: rpy" + expected});
    refusals.push_back({{"'0.6 0 0.8'", quoted}, in_joint + "<axis>: xyz" + expected});
    refusals.push_back({{"'0.1 0 0.1'", quoted}, in_link + "<origin>: xyz" + expected});
    refusals.push_back({{"'0.5 0 0'", quoted}, in_link + "<origin>: rpy" + expected});
  }
  const ScratchFolder folder;
  for (const Refusal& one : refusals) {
    put_arm(folder, {}, one.edit);
    const std::string message = load_refusal(folder);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(
        one.message.c_str(), message.substr(0, one.message.size()).c_str(), one.edit.to.c_str());
    TEST_ASSERT_TRUE_MESSAGE(message.find('\n') == std::string::npos, message.c_str());
  }
}

void what_the_urdf_standard_leaves_out_may_be_left_out() {
  const Edit edits[] = {
      {" rpy='0.1 -0.4 1.1'", ""},
      {"<origin xyz='0.3 0.1 -0.2' rpy='0.1 -0.4 1.1'/>", ""},
      {"<origin xyz='0.1 0 0.1' rpy='0.5 0 0'/>", ""},
      {"'0.3 0.1 -0.2'", "'  +3e-1 .1   -2.e-1 '"},
      {"velocity='2'", "velocity='2' acceleration='8'"},
      {"<axis", "<dynamics damping='1'/><safety_controller k_velocity='1'/><axis"},
      {"<link name='base'/>", "<link name='base'><visual/><self_collide/></link><gazebo/>"},
  };
  const ScratchFolder folder;
  for (const Edit& edit : edits) {
    put_arm(folder, {}, edit);
    TEST_ASSERT_EQUAL_STRING("accepted", load_refusal(folder).c_str());
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
  std::string message = load_refusal(folder);
  TEST_ASSERT_TRUE_MESSAGE(message.find("arm.urdf: has no link 'bass', which ") == 0,
                           message.c_str());
  TEST_ASSERT_TRUE_MESSAGE(message.find("names; it has base, ") != std::string::npos,
                           message.c_str());
  put_arm(folder, {"tool_link: tool", "tool_link: tol"});
  message = load_refusal(folder);
  TEST_ASSERT_TRUE_MESSAGE(message.find("arm.urdf: has no link 'tol', which ") == 0,
                           message.c_str());
  put_arm(folder, {"tool_link: tool", "tool_link: other"});
  TEST_ASSERT_EQUAL_STRING(
      "arm.urdf: expected 1 to 12 revolute, continuous or prismatic joints between 'base' and "
      "'other', found 0",
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
  put_arm(folder, {}, {"type='revolute'", "type='gliding'"});
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
  RUN_TEST(springs_of_a_desktop_arm_and_softer_are_read);
  RUN_TEST(a_urdf_that_is_wrong_is_refused_with_the_link_or_joint);
  RUN_TEST(more_joints_than_there_is_room_for_are_refused);
  RUN_TEST(the_core_is_given_six_revolute_joints_only);
  RUN_TEST(a_urdf_value_that_cannot_be_read_is_refused_with_its_line);
  RUN_TEST(what_the_urdf_standard_leaves_out_may_be_left_out);
  RUN_TEST(a_file_that_is_none_is_refused);
  RUN_TEST(a_urdf_that_is_no_urdf_is_refused);
  RUN_TEST(links_that_form_a_loop_or_have_two_parents_are_refused);
  RUN_TEST(names_of_two_lines_are_named_in_one);
  RUN_TEST(links_that_are_not_there_are_named);
  RUN_TEST(the_urdf_parser_prints_nothing_of_its_own);
  return UNITY_END();
}
