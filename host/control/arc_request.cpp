#include "control/arc_request.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "error.hpp"
#include "model/yaml_map.hpp"

namespace flexcomp::control {
namespace {

using model::YamlMap;

template <std::size_t Count>
Eigen::Matrix<double, static_cast<int>(Count), 1> vector(const YamlMap& yaml,
                                                         const std::string& key) {
  const auto values = yaml.numbers<Count>(key);
  return Eigen::Map<const Eigen::Matrix<double, static_cast<int>(Count), 1>>(values.data());
}

FuzzyNumber read_set(const YamlMap& yaml) {
  yaml.allow_only({"triangular", "trapezoidal", "values", "degrees"});
  if (yaml.has("triangular")) {
    const auto corners = yaml.numbers<3>("triangular");
    return FuzzyNumber::triangular(corners[0], corners[1], corners[2]);
  }
  if (yaml.has("trapezoidal")) {
    const auto corners = yaml.numbers<4>("trapezoidal");
    return FuzzyNumber::trapezoidal(corners[0], corners[1], corners[2], corners[3]);
  }
  const std::vector<double> values = yaml.list("values");
  const std::vector<double> degrees = yaml.list("degrees");
  if (values.size() != degrees.size()) {
    yaml.refuse("degrees", "expected as many degrees as values");
  }
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < values.size(); ++i) {
    points.emplace_back(values[i], degrees[i]);
  }
  return FuzzyNumber::tabulated(points);
}

ArmUncertainty read_uncertainty(const YamlMap& yaml, const simulation::FlexibleArm<6>& arm) {
  ArmUncertainty set;
  set.payload = FuzzyNumber::crisp(arm.model.payload_mass);
  const std::vector<std::pair<std::string, FuzzyNumber*>> names = {
      {"payload", &set.payload},        {"link_mass", &set.link_mass},
      {"stiffness", &set.stiffness},    {"rotor_inertia", &set.rotor_inertia},
      {"viscous", &set.viscous},        {"coulomb", &set.coulomb},
      {"tool_force", &set.tool_force},  {"joint_load", &set.joint_load},
      {"start_error", &set.start_error}};
  std::vector<std::string> allowed;
  allowed.reserve(names.size());
  for (const auto& [name, number] : names) {
    allowed.push_back(name);
  }
  yaml.allow_only(allowed);
  for (const auto& [name, number] : names) {
    if (yaml.has(name)) {
      try {
        *number = read_set(yaml.map(name));
      } catch (const InputError& error) {
        yaml.refuse(name, error.what());
      }
    }
  }
  return set;
}

void read_arm(const YamlMap& yaml, simulation::FlexibleArm<6>* arm) {
  yaml.allow_only({"rotor_inertia", "viscous", "coulomb", "gravity", "payload"});
  const auto read = [&](const std::string& key, JointVector<double, 6>* values) {
    if (yaml.has(key)) {
      *values = vector<6>(yaml, key);
      if (values->minCoeff() < 0) {
        yaml.refuse(key, "must not be negative");
      }
    }
  };
  read("rotor_inertia", &arm->rotor_inertia);
  read("viscous", &arm->viscous);
  read("coulomb", &arm->coulomb);
  if (yaml.has("gravity")) {
    arm->model.gravity = vector<3>(yaml, "gravity");
  }
  if (yaml.has("payload")) {
    const YamlMap payload = yaml.map("payload");
    payload.allow_only({"mass", "com"});
    arm->model.payload_mass = payload.non_negative("mass");
    arm->model.payload_center = vector<3>(payload, "com");
  }
}

double positive(const YamlMap& yaml, const std::string& key) {
  const double value = yaml.number(key);
  if (!(value > 0)) {
    yaml.refuse(key, "expected a number above zero");
  }
  return value;
}

ArcBandwidth read_bandwidth(const YamlMap& yaml) {
  ArcBandwidth bandwidth;
  const std::vector<std::pair<std::string, double*>> names = {
      {"period", &bandwidth.period},
      {"link_rate", &bandwidth.link_rate},
      {"link_damping", &bandwidth.link_damping},
      {"motor_rate", &bandwidth.motor_rate},
      {"motor_damping", &bandwidth.motor_damping},
      {"motor_stiffness", &bandwidth.motor_stiffness},
      {"filter_frequency", &bandwidth.filter_frequency},
      {"leak", &bandwidth.leak},
      {"link_gain_limit", &bandwidth.link_gain_limit},
      {"motor_gain_limit", &bandwidth.motor_gain_limit},
      {"surface_speed", &bandwidth.surface_speed},
      {"residual_time", &bandwidth.residual_time},
      {"effort", &bandwidth.effort}};
  std::vector<std::string> allowed;
  allowed.reserve(names.size());
  for (const auto& [name, value] : names) {
    allowed.push_back(name);
  }
  yaml.allow_only(allowed);
  for (const auto& [name, value] : names) {
    if (yaml.has(name)) {
      *value = positive(yaml, name);
    }
  }
  return bandwidth;
}

/// The robot as an arm: dynamics from its files.
simulation::FlexibleArm<6> flexible_arm(const model::Robot& robot) {
  simulation::FlexibleArm<6> arm;
  arm.model = model::six_axis_model(robot);
  std::copy(robot.link_inertia.begin(), robot.link_inertia.end(), arm.inertia.begin());
  for (std::size_t i = 0; i < 6; ++i) {
    const auto joint = static_cast<Eigen::Index>(i);
    arm.rotor_inertia[joint] = robot.dynamics[i].rotor_inertia;
    arm.viscous[joint] = robot.dynamics[i].viscous;
    arm.coulomb[joint] = robot.dynamics[i].coulomb;
    arm.torque_limit[joint] = robot.dynamics[i].effort;
  }
  return arm;
}

}  // namespace

ArcRequest read_arc_request(const std::filesystem::path& file, const model::Robot& robot) {
  const YamlMap yaml = model::load_yaml(file);
  if (yaml.text("schema") != "flexcomp/arc-design/1") {
    yaml.refuse("schema", "expected flexcomp/arc-design/1");
  }
  yaml.allow_only({"schema", "arm", "motion", "uncertain", "bandwidth"});
  ArcRequest request;
  request.arm = flexible_arm(robot);
  if (yaml.has("arm")) {
    read_arm(yaml.map("arm"), &request.arm);
  }
  if (!(request.arm.rotor_inertia.minCoeff() > 0)) {
    throw InputError(file.string() +
                     ": every joint needs a rotor_inertia above zero, in robot.yaml or under arm");
  }
  for (const Joint<double>& joint : request.arm.model.joints) {
    if (!(joint.compliance > 0)) {
      throw InputError(robot.yaml.string() + ": every joint needs a compliance above zero");
    }
  }
  const YamlMap motion = yaml.map("motion");
  motion.allow_only({"velocity", "acceleration", "jerk"});
  request.motion = {positive(motion, "velocity"), positive(motion, "acceleration"),
                    positive(motion, "jerk")};
  request.uncertainty = read_uncertainty(yaml.map("uncertain"), request.arm);
  if (yaml.has("bandwidth")) {
    request.bandwidth = read_bandwidth(yaml.map("bandwidth"));
  }
  return request;
}

}  // namespace flexcomp::control
