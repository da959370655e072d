#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "files/one_line.hpp"
#include "linux/printable_line.hpp"
#include "model/plausible_springs.hpp"
#include "model/robot.hpp"
#include "model/robot_schema.hpp"
#include "model/urdf_chain.hpp"
#include "model/yaml_map.hpp"

namespace flexcomp::model {
namespace {

template <typename Vector, std::size_t Size>
Vector vector(const std::array<double, Size>& values) {
  return Eigen::Map<const Vector>(values.data());
}

void refuse_softer_than(double most, const char* unit, double found, const YamlMap& yaml,
                        const std::string& key) {
  if (std::abs(found) > most) {
    yaml.refuse(key, fmt::format("{:g} {} is softer than any robot; expected {:g} {} at most",
                                 found, unit, most, unit));
  }
}

DiagonalCompliance<double> read_compliance(const YamlMap& yaml, const std::string& key) {
  if (!yaml.has(key)) {
    return DiagonalCompliance<double>::Zero();
  }
  const auto values = yaml.numbers<6>(key);
  if (std::any_of(values.begin(), values.end(), [](double value) { return value < 0; })) {
    yaml.refuse(key, "a compliance must not be negative");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    refuse_softer_than(i < 3 ? kMostShift : kMostTurn, i < 3 ? "m/N" : "rad/(N·m)", values[i], yaml,
                       key);
  }
  return vector<DiagonalCompliance<double>>(values);
}

void read_joint(const YamlMap& yaml, ChainJoint* spring, JointDynamics* dynamics) {
  yaml.allow_only({"compliance", "viscous", "coulomb", "rotor_inertia", "backlash",
                   "cubic_compliance", "link_compliance"});
  spring->compliance = yaml.non_negative("compliance");
  refuse_softer_than(softest_of(*spring), spring->slides() ? "m/N" : "rad/(N·m)",
                     spring->compliance, yaml, "compliance");
  spring->cubic_compliance = yaml.number_or("cubic_compliance", 0);
  refuse_softer_than(softest_cubic_of(*spring), spring->slides() ? "m/N³" : "rad/(N·m)³",
                     spring->cubic_compliance, yaml, "cubic_compliance");
  spring->link_compliance = read_compliance(yaml, "link_compliance");
  dynamics->viscous = yaml.non_negative_or("viscous", 0);
  dynamics->coulomb = yaml.non_negative_or("coulomb", 0);
  dynamics->rotor_inertia = yaml.non_negative_or("rotor_inertia", 0);
  dynamics->backlash = yaml.non_negative_or("backlash", 0);
}

void read_joints(const YamlMap& yaml, Robot* robot) {
  yaml.allow_only(
      {robot->joint_names.begin(), robot->joint_names.end()},
      fmt::format("no joint that moves between '{}' and '{}' has this name",
                  files::one_line(robot->base_link), files::one_line(robot->tool_link)));
  for (std::size_t i = 0; i < robot->joint_names.size(); ++i) {
    read_joint(yaml.map(robot->joint_names[i]), &robot->elastic.joints[i], &robot->dynamics[i]);
  }
}

void read_payload(const YamlMap& yaml, Chain* elastic) {
  yaml.allow_only({"mass", "com"});
  elastic->payload_mass = yaml.non_negative("mass");
  if (yaml.has("com")) {
    elastic->payload_center = vector<Vector3<double>>(yaml.numbers<3>("com"));
  }
}

double read_temperature(const YamlMap& yaml, const std::string& key) {
  constexpr double kAbsoluteZero = -273.15;  // °C
  const double temperature = yaml.number(key);
  if (temperature < kAbsoluteZero) {
    yaml.refuse(key, fmt::format("expected °C; nothing is colder than {:g}", kAbsoluteZero));
  }
  return temperature;
}

JointMatrix read_transmission(const YamlMap& yaml, Eigen::Index joints) {
  JointMatrix transmission = yaml.square("transmission", joints);
  if (!is_transmission(transmission)) {
    yaml.refuse("transmission", "the motors must tell the joints' angles: it has no inverse");
  }
  return transmission;
}

LearnedEffect read_law(const YamlMap& yaml, int joints) {
  LearnedEffect learned;
  learned.effect = kLaw;
  learned.joint = read_joint_number(yaml, joints);
  learned.law = read_written_law(yaml);
  for (const std::string& key : yaml.keys()) {
    if (!is_key_of_law(key)) {
      learned.parameters[key] = yaml.number(key);
    }
  }
  return learned;
}

LearnedEffect read_effect(const YamlMap& yaml, int joints) {
  if (yaml.text("effect") == kLaw) {
    return read_law(yaml, joints);
  }
  LearnedEffect learned;
  learned.effect = yaml.text("effect");
  learned.place = yaml.place_of("effect");
  learned.form = yaml.has("form") ? yaml.text("form") : "";
  learned.joint = read_joint_number(yaml, joints);
  for (const std::string& key : yaml.keys()) {
    if (key != "effect" && key != "form" && key != "joint") {
      learned.parameters[key] = yaml.number(key);
    }
  }
  return learned;
}

/// The tool that was asked for, else the file's. The file's is read in any case, as all of it is.
void attach_tool(const YamlMap& yaml, const std::optional<Tool>& asked_for, Robot* robot) {
  std::optional<Tool> tool;
  if (yaml.has("tool")) {
    tool = read_tool(yaml.map("tool"));
  }
  if (asked_for) {
    tool = asked_for;
  }
  if (tool) {
    attach(*tool, robot);
  }
}

std::filesystem::path urdf_beside(const std::filesystem::path& file, const YamlMap& yaml) {
  std::filesystem::path urdf = file.parent_path() / yaml.text("urdf");
  std::error_code error;
  if (!std::filesystem::exists(urdf, error)) {
    yaml.refuse("urdf", fmt::format("no such file: {}", files::one_line(urdf.string(), 1000)));
  }
  return urdf;
}

bool is_computable(const Robot& robot) {
  return validate(robot.elastic) == Result::ok &&
         std::all_of(robot.link_inertia.begin(), robot.link_inertia.end(),
                     [](const Matrix3<double>& inertia) { return inertia.allFinite(); });
}

}  // namespace

void Robot::set_joints(std::size_t count) {
  elastic.joints.assign(count, {});
  joint_names.assign(count, {});
  dynamics.assign(count, {});
  link_inertia.assign(count, Matrix3<double>::Zero());
  transmission = JointMatrix::Identity(elastic.size(), elastic.size());
}

RobotModel<double, 6> six_axis_model(const Robot& robot) {
  const std::string expected =
      fmt::format("expected six revolute joints between '{}' and '{}'",
                  files::one_line(robot.base_link), files::one_line(robot.tool_link));
  for (std::size_t i = 0; i < robot.elastic.joints.size(); ++i) {
    const JointType type = robot.elastic.joints[i].type;
    if (type != JointType::revolute) {
      throw InputError(fmt::format(
          "{}: joint '{}': is {}{}; {}", robot.urdf.string(), files::one_line(robot.joint_names[i]),
          name_of(type), type == JointType::continuous ? ", so without limits" : "", expected));
    }
  }
  const std::optional<RobotModel<double, 6>> model = six_axis_model(robot.elastic);
  if (!model) {
    throw InputError(
        fmt::format("{}: {}, found {}", robot.urdf.string(), expected, robot.joints()));
  }
  return *model;
}

Robot load_robot(const std::filesystem::path& file, const std::optional<Tool>& tool) {
  const YamlMap yaml = load_yaml(file);
  const std::string schema = yaml.text("schema");
  if (schema != kRobotSchema) {
    yaml.refuse("schema",
                fmt::format("expected {}, found {}", kRobotSchema, files::one_line(schema)));
  }
  yaml.allow_only({"schema", "name", "urdf", "base_link", "tool_link", "gravity", "joints",
                   "base_compliance", "tool_compliance", "payload", "tool", "transmission",
                   "reference_temperature", "effects"});
  Robot robot;
  robot.yaml = file;
  robot.name = yaml.text("name");
  if (printable_line(robot.name) != robot.name) {  // it stands in reports, configurations and JSON
    yaml.refuse("name", "expected one line of UTF-8 without control characters");
  }
  robot.urdf = urdf_beside(file, yaml);
  robot.base_link = yaml.text("base_link");
  robot.tool_link = yaml.text("tool_link");
  read_urdf_chain(robot.urdf, &robot);
  attach_tool(yaml, tool, &robot);

  robot.elastic.gravity = vector<Vector3<double>>(yaml.numbers<3>("gravity"));
  read_joints(yaml.map("joints"), &robot);
  robot.elastic.base_compliance = read_compliance(yaml, "base_compliance");
  robot.elastic.tool_compliance = read_compliance(yaml, "tool_compliance");
  if (yaml.has("payload")) {
    read_payload(yaml.map("payload"), &robot.elastic);
  }
  if (yaml.has("transmission")) {
    robot.transmission = read_transmission(yaml, robot.elastic.size());
  }
  if (yaml.has("reference_temperature")) {
    robot.reference_temperature = read_temperature(yaml, "reference_temperature");
  }
  if (yaml.has("effects")) {
    for (const YamlMap& effect : yaml.maps("effects")) {
      robot.effects.push_back(read_effect(effect, robot.joints()));
    }
  }
  if (!is_computable(robot)) {
    throw InputError(
        fmt::format("{}: a length or mass is too large to compute with", robot.urdf.string()));
  }
  return robot;
}

}  // namespace flexcomp::model
