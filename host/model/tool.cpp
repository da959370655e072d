#include "model/tool.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "files/one_line.hpp"
#include "model/frame_numbers.hpp"
#include "model/rigid_body.hpp"
#include "model/robot.hpp"
#include "model/whole_turn.hpp"
#include "model/yaml_map.hpp"

namespace flexcomp::model {
namespace {

constexpr const char* kToolsSchema = "flexcomp/tools/1";

Matrix3<double> tensor(const std::array<double, 6>& inertia) {
  const auto& [xx, xy, xz, yy, yz, zz] = inertia;
  Matrix3<double> matrix;
  matrix << xx, xy, xz,  //
      xy, yy, yz,        //
      xz, yz, zz;
  return matrix;
}

/// No principal moment is negative, or larger than the sum of the other two; rounding aside.
bool is_of_a_body(const Matrix3<double>& inertia) {
  const Vector3<double> moments =
      Eigen::SelfAdjointEigenSolver<Matrix3<double>>(inertia, Eigen::EigenvaluesOnly).eigenvalues();
  const double rounding = 1e-6 * moments.cwiseAbs().maxCoeff();
  return moments[0] >= -rounding && moments[2] <= moments[0] + moments[1] + rounding;
}

template <std::size_t Count>
std::array<double, Count> numbers_or_zero(const YamlMap& yaml, const std::string& key) {
  return yaml.has(key) ? yaml.numbers<Count>(key) : std::array<double, Count>{};
}

}  // namespace

Pose<double> Tool::mounting() const {
  return frame_of_numbers({xyz[0], xyz[1], xyz[2], rpy[0], rpy[1], rpy[2]});
}

Tool read_tool(const YamlMap& yaml) {
  yaml.allow_only({"xyz", "rpy", "mass", "com", "inertia"});
  Tool tool;
  tool.xyz = yaml.numbers<3>("xyz");
  tool.rpy = numbers_or_zero<3>(yaml, "rpy");
  for (const double angle : tool.rpy) {
    if (is_beyond_a_turn(angle)) {
      yaml.refuse("rpy",
                  fmt::format("expected radians, found {:g}, which is more than a turn", angle));
    }
  }
  tool.mass = yaml.non_negative_or("mass", 0);
  tool.com = numbers_or_zero<3>(yaml, "com");
  tool.inertia = numbers_or_zero<6>(yaml, "inertia");
  if (!is_of_a_body(tensor(tool.inertia))) {
    yaml.refuse("inertia", "no body has this inertia; expected ixx, ixy, ixz, iyy, iyz, izz");
  }
  for (const char* key : {"com", "inertia"}) {
    if (yaml.has(key) && tool.mass == 0) {
      yaml.refuse(key, "a tool without mass has none");
    }
  }
  return tool;
}

Tool load_tool(const std::filesystem::path& file, const std::string& name) {
  const YamlMap yaml = load_yaml(file);
  yaml.allow_only({"schema", "tools"});
  const std::string schema = yaml.text("schema");
  if (schema != kToolsSchema) {
    yaml.refuse("schema",
                fmt::format("expected {}, found {}", kToolsSchema, files::one_line(schema)));
  }
  const YamlMap tools = yaml.map("tools");
  const std::vector<std::string> names = tools.keys();
  if (name.empty() && names.size() == 1) {
    return read_tool(tools.map(names.front()));
  }
  if (name.empty() || !tools.has(name)) {
    yaml.refuse("tools",
                fmt::format("{}; expected one of: {}",
                            name.empty() ? "holds more than one or none: which?"
                                         : "has no '" + files::one_line(name) + "'",
                            files::one_line(fmt::format("{}", fmt::join(names, ", ")), 200)));
  }
  return read_tool(tools.map(name));
}

void attach(const Tool& tool, Robot* robot) {
  ChainJoint& last = robot->elastic.joints.back();
  Matrix3<double>& inertia = robot->link_inertia.back();
  const Pose<double> flange = robot->elastic.tool;
  RigidBody body;
  body.add(last.mass, last.center_of_mass, inertia);
  body.add(tool.mass, flange.rotation * Vector3<double>(tool.com.data()) + flange.position,
           flange.rotation * tensor(tool.inertia) * flange.rotation.transpose());
  last.mass = body.mass();
  last.center_of_mass = body.center_of_mass();
  inertia = body.inertia_at_center();
  robot->elastic.tool = flange * tool.mounting();
  robot->tool = tool;
}

}  // namespace flexcomp::model
