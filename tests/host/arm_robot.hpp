#pragma once

#include <stdexcept>
#include <string>

#include "host/scratch_folder.hpp"

namespace flexcomp::test {

inline const char* const kArmYaml = R"(schema: flexcomp/robot/1
name: An arm
urdf: arm.urdf
base_link: base
tool_link: tool
gravity: [0, 0, -9.81]
joints:
  j1: {compliance: 1e-6}
  j2: {compliance: 2e-6, backlash: 1e-4}
  j3: {compliance: 3e-6}
  j4: {compliance: 4e-6}
  j5: {compliance: 5e-6}
  j6: {compliance: 6e-6}
payload: {mass: 7}
)";

/// One joint and the link that it moves; # stands for their number, @ for the link before.
inline const char* const kArmLink = R"(<joint name='j#' type='revolute'><parent link='@'/>
<child link='l#'/><origin xyz='0.3 0.# -0.2' rpy='0.# -0.4 1.#'/><axis xyz='0.6 0 0.8'/>
<limit lower='-1' upper='1' effort='10' velocity='2'/></joint>
<link name='l#'><inertial><origin xyz='0.1 0 0.#' rpy='0.5 0 0'/><mass value='#'/>
<inertia ixx='1' iyy='2' izz='2.5' ixy='0.1' ixz='0' iyz='0.2'/></inertial></link>
)";

/// Six turned joints about odd axes, a bracket fixed to link 3 and a finger that slides on link 6.
inline std::string arm_urdf() {
  std::string text = "<robot name='arm'>\n<link name='base'/>\n";
  std::string parent = "base";
  for (const char* number : {"1", "2", "3", "4", "5", "6"}) {
    for (const char c : std::string(kArmLink)) {
      text += c == '#' ? std::string(number) : c == '@' ? parent : std::string(1, c);
    }
    parent = std::string("l") + number;
  }
  return text + R"(<joint name='bolted' type='fixed'><parent link='l3'/><child link='bracket'/>
<origin xyz='0.2 -0.1 0.4' rpy='0.3 0.2 0.1'/></joint>
<link name='bracket'><inertial><origin xyz='0 0.05 0' rpy='0 0 0.7'/><mass value='11'/>
<inertia ixx='0.3' iyy='0.2' izz='0.4' ixy='0' ixz='0.05' iyz='0'/></inertial></link>
<joint name='slide' type='prismatic'><parent link='l6'/><child link='finger'/>
<origin xyz='0 0 0.5'/><axis xyz='1 0 0'/><limit lower='0' upper='0.1' effort='1' velocity='1'/></joint>
<link name='finger'><inertial><mass value='2'/>
<inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link>
<joint name='plate' type='fixed'><parent link='l6'/><child link='flange'/>
<origin xyz='0.1 0 0.2' rpy='0 1.2 0'/></joint>
<link name='flange'/>
<joint name='holder' type='fixed'><parent link='flange'/><child link='tool'/>
<origin xyz='0 0.3 0' rpy='0.4 0 0'/></joint>
<link name='tool'/>
<link name='other'/>
<joint name='beside' type='fixed'><parent link='base'/><child link='other'/></joint>
</robot>
)";
}

/// One place in a text that is changed; nothing where `from` is empty.
struct Edit {
  std::string from;
  std::string to;
};

inline std::string edited(std::string text, const Edit& edit) {
  if (!edit.from.empty()) {
    const std::size_t at = text.find(edit.from);
    if (at == std::string::npos) {
      throw std::logic_error("nothing to edit: " + edit.from);
    }
    text.replace(at, edit.from.size(), edit.to);
  }
  return text;
}

/// Writes robot.yaml and arm.urdf.
inline void put_arm(const ScratchFolder& folder, const Edit& yaml = {}, const Edit& urdf = {}) {
  put(folder / "robot.yaml", edited(kArmYaml, yaml));
  put(folder / "arm.urdf", edited(arm_urdf(), urdf));
}

}  // namespace flexcomp::test
