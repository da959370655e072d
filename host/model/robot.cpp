#include "model/robot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "error.hpp"
#include "model/urdf_chain.hpp"
#include "model/yaml_map.hpp"

namespace flexcomp::model {
namespace {

constexpr const char* kSchema = "flexcomp/robot/1";

template <typename Vector, std::size_t Size>
Vector vector(const std::array<double, Size>& values) {
  return Eigen::Map<const Vector>(values.data());
}

DiagonalCompliance<double> read_compliance(YamlMap* yaml, const std::string& key) {
  if (!yaml->has(key)) {
    return DiagonalCompliance<double>::Zero();
  }
  const auto values = yaml->numbers<6>(key);
  if (std::any_of(values.begin(), values.end(), [](double value) { return value < 0; })) {
    yaml->refuse(key, "a compliance must not be negative");
  }
  return vector<DiagonalCompliance<double>>(values);
}

void read_joint(YamlMap yaml, Joint<double>* spring, JointDynamics* dynamics) {
  spring->compliance = yaml.positive_number("compliance");
  spring->cubic_compliance = yaml.number_or("cubic_compliance", 0);
  spring->link_compliance = read_compliance(&yaml, "link_compliance");
  dynamics->viscous = yaml.positive_number_or("viscous", 0);
  dynamics->coulomb = yaml.positive_number_or("coulomb", 0);
  dynamics->rotor_inertia = yaml.positive_number_or("rotor_inertia", 0);
  dynamics->backlash = yaml.positive_number_or("backlash", 0);
  yaml.refuse_other_keys();
}

void read_payload(YamlMap yaml, RobotModel<double, 6>* elastic) {
  elastic->payload_mass = yaml.positive_number("mass");
  if (yaml.has("com")) {
    elastic->payload_center = vector<Vector3<double>>(yaml.numbers<3>("com"));
  }
  yaml.refuse_other_keys();
}

}  // namespace

Robot load_robot(const std::filesystem::path& file) {
  YamlMap yaml = load_yaml(file.string());
  const std::string schema = yaml.text("schema");
  if (schema != kSchema) {
    yaml.refuse("schema", fmt::format("expected {}, found {}", kSchema, schema));
  }
  Robot robot;
  robot.yaml = file;
  robot.name = yaml.text("name");
  robot.urdf = file.parent_path() / yaml.text("urdf");
  robot.base_link = yaml.text("base_link");
  robot.tool_link = yaml.text("tool_link");
  read_urdf_chain(robot.urdf, &robot);

  robot.elastic.gravity = vector<Vector3<double>>(yaml.numbers<3>("gravity"));
  YamlMap joints = yaml.map("joints");
  for (std::size_t i = 0; i < robot.joint_names.size(); ++i) {
    read_joint(joints.map(robot.joint_names[i]), &robot.elastic.joints[i], &robot.dynamics[i]);
  }
  joints.refuse_other_keys();
  robot.elastic.base_compliance = read_compliance(&yaml, "base_compliance");
  robot.elastic.tool_compliance = read_compliance(&yaml, "tool_compliance");
  if (yaml.has("payload")) {
    read_payload(yaml.map("payload"), &robot.elastic);
  }
  yaml.refuse_other_keys();
  if (validate(robot.elastic) != Result::ok) {
    throw InputError(fmt::format("{}: a number is not finite or out of its range",
                                 robot.urdf.string()));
  }
  return robot;
}

}  // namespace flexcomp::model
