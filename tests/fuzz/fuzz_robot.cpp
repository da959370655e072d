// Any bytes as a robot's two files: refused in one line, or a model that the core accepts.
//
// Input: the YAML file, a line "%%%", the URDF.
#include <filesystem>
#include <string>

#include "byte_source.hpp"
#include "complaint.hpp"
#include "flexcomp/chain.hpp"
#include "host/scratch_folder.hpp"
#include "model/chain_kinematics.hpp"
#include "model/robot.hpp"

using namespace flexcomp;
using flexcomp::fuzz::expect;

namespace {

const test::ScratchFolder& folder() {
  static const test::ScratchFolder kFolder;
  return kFolder;
}

}  // namespace

/// Where all links of a URDF form a loop, urdfdom refuses them itself, and forgets to free them.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:urdf::parseURDF"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  const std::string separator = "\n%%%\n";
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::filesystem::path yaml = folder() / "robot.yaml";
  test::put(yaml, text.substr(0, end));
  test::put(folder() / "robot.urdf",
            end < text.size() ? text.substr(end + separator.size()) : std::string());
  fuzz::expect_one_line_or_none((folder() / "robot").string(), [&] {
    const model::Robot robot = model::load_robot(yaml);
    expect(validate(robot.elastic) == Result::ok, "a robot that was read is computable");
    const model::JointValues q = model::JointValues::Zero(robot.joints());
    expect(forward_kinematics(robot.elastic, q).tcp.position.allFinite(),
           "its kinematics are finite");
    const std::filesystem::path again = folder() / "robot.again.yaml";
    model::write_robot(again, robot);
    expect(model::load_robot(again).name == robot.name, "what is written is read again");
  });
  return 0;
}
