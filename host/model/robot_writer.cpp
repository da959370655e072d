#include <fmt/format.h>
#include <yaml-cpp/emitter.h>

#include <Eigen/SVD>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "error.hpp"
#include "files/text_file.hpp"
#include "linux/printable_line.hpp"
#include "model/plausible_springs.hpp"
#include "model/robot.hpp"
#include "model/robot_schema.hpp"

namespace flexcomp::model {
namespace {

/// The shortest text that reads back as the same number. A number such as 2e-06, without a point,
/// is a text to readers of YAML 1.1.
std::string number(double value) {
  std::string text = fmt::format("{}", value);
  const std::size_t exponent = text.find('e');
  if (exponent != std::string::npos && text.find('.') == std::string::npos) {
    text.insert(exponent, ".0");
  }
  return text;
}

template <typename Derived>
void write_list(YAML::Emitter* out, const std::string& key,
                const Eigen::MatrixBase<Derived>& values) {
  *out << YAML::Key << key << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    *out << number(values(i));
  }
  *out << YAML::EndSeq;
}

template <typename Derived>
void write_list_unless_zero(YAML::Emitter* out, const std::string& key,
                            const Eigen::MatrixBase<Derived>& values) {
  if (!values.isZero(0)) {
    write_list(out, key, values);
  }
}

void write_number_unless_zero(YAML::Emitter* out, const std::string& key, double value) {
  if (value != 0) {
    *out << YAML::Key << key << YAML::Value << number(value);
  }
}

void write_joint(YAML::Emitter* out, const std::string& name, const ChainJoint& spring,
                 const JointDynamics& dynamics) {
  *out << YAML::Key << name << YAML::Value << YAML::BeginMap;
  *out << YAML::Key << "compliance" << YAML::Value << number(spring.compliance);
  write_number_unless_zero(out, "viscous", dynamics.viscous);
  write_number_unless_zero(out, "coulomb", dynamics.coulomb);
  write_number_unless_zero(out, "rotor_inertia", dynamics.rotor_inertia);
  write_number_unless_zero(out, "backlash", dynamics.backlash);
  write_number_unless_zero(out, "cubic_compliance", spring.cubic_compliance);
  write_list_unless_zero(out, "link_compliance", spring.link_compliance);
  *out << YAML::EndMap;
}

void write_payload(YAML::Emitter* out, const Chain& elastic) {
  if (elastic.payload_mass == 0 && elastic.payload_center.isZero(0)) {
    return;
  }
  *out << YAML::Key << "payload" << YAML::Value << YAML::BeginMap;
  *out << YAML::Key << "mass" << YAML::Value << number(elastic.payload_mass);
  write_list(out, "com", elastic.payload_center);
  *out << YAML::EndMap;
}

template <std::size_t Count>
void write_numbers(YAML::Emitter* out, const std::string& key,
                   const std::array<double, Count>& values) {
  write_list_unless_zero(out, key,
                         Eigen::Map<const Eigen::Matrix<double, Count, 1>>(values.data()));
}

void write_tool(YAML::Emitter* out, const Tool& tool) {
  *out << YAML::Key << "tool" << YAML::Value << YAML::BeginMap;
  write_list(out, "xyz", Vector3<double>(tool.xyz.data()));
  write_numbers(out, "rpy", tool.rpy);
  write_number_unless_zero(out, "mass", tool.mass);
  write_numbers(out, "com", tool.com);
  write_numbers(out, "inertia", tool.inertia);
  *out << YAML::EndMap;
}

void write_text(YAML::Emitter* out, const std::string& key, const std::string& text) {
  *out << YAML::Key << key << YAML::Value << text;
}

void write_transmission(YAML::Emitter* out, const JointMatrix& transmission) {
  if (transmission.isIdentity(0)) {
    return;
  }
  *out << YAML::Key << "transmission" << YAML::Value << YAML::BeginSeq;
  for (Eigen::Index row = 0; row < transmission.rows(); ++row) {
    *out << YAML::Flow << YAML::BeginSeq;
    for (Eigen::Index column = 0; column < transmission.cols(); ++column) {
      *out << number(transmission(row, column));
    }
    *out << YAML::EndSeq;
  }
  *out << YAML::EndSeq;
}

void write_law(YAML::Emitter* out, const WrittenLaw& law) {
  write_text(out, "place", law.place);
  if (!law.axis.empty()) {
    write_text(out, "axis", law.axis);
  }
  *out << YAML::Key << "formula" << YAML::Value << YAML::DoubleQuoted << law.formula;
  if (!law.units.empty()) {
    *out << YAML::Key << "units" << YAML::Value << YAML::BeginMap;
    for (const auto& [name, unit] : law.units) {
      write_text(out, name, unit);
    }
    *out << YAML::EndMap;
  }
}

void write_effects(YAML::Emitter* out, const std::vector<LearnedEffect>& effects) {
  if (effects.empty()) {
    return;
  }
  *out << YAML::Key << "effects" << YAML::Value << YAML::BeginSeq;
  for (const LearnedEffect& learned : effects) {
    *out << YAML::Flow << YAML::BeginMap;
    write_text(out, "effect", learned.effect);
    if (learned.joint > 0) {
      *out << YAML::Key << "joint" << YAML::Value << learned.joint;
    }
    if (!learned.form.empty()) {
      write_text(out, "form", learned.form);
    }
    if (learned.law) {
      write_law(out, *learned.law);
    }
    for (const auto& [name, value] : learned.parameters) {
      *out << YAML::Key << name << YAML::Value << number(value);
    }
    *out << YAML::EndMap;
  }
  *out << YAML::EndSeq;
}

std::string document(const Robot& robot, const std::string& urdf) {
  YAML::Emitter out;
  out << YAML::BeginMap;
  write_text(&out, "schema", kRobotSchema);
  write_text(&out, "name", robot.name);
  write_text(&out, "urdf", urdf);
  write_text(&out, "base_link", robot.base_link);
  write_text(&out, "tool_link", robot.tool_link);
  write_list(&out, "gravity", robot.elastic.gravity);
  out << YAML::Key << "joints" << YAML::Value << YAML::BeginMap;
  for (std::size_t i = 0; i < robot.joint_names.size(); ++i) {
    write_joint(&out, robot.joint_names[i], robot.elastic.joints[i], robot.dynamics[i]);
  }
  out << YAML::EndMap;
  write_list_unless_zero(&out, "base_compliance", robot.elastic.base_compliance);
  write_list_unless_zero(&out, "tool_compliance", robot.elastic.tool_compliance);
  write_payload(&out, robot.elastic);
  if (robot.tool) {
    write_tool(&out, *robot.tool);
  }
  write_transmission(&out, robot.transmission);
  if (robot.reference_temperature) {
    out << YAML::Key << "reference_temperature" << YAML::Value
        << number(*robot.reference_temperature);
  }
  write_effects(&out, robot.effects);
  out << YAML::EndMap << YAML::Newline;
  return out.c_str();
}

bool has_joints(const Robot& robot) {
  const std::size_t count = robot.elastic.joints.size();
  return robot.joint_names.size() == count && robot.dynamics.size() == count &&
         robot.transmission.rows() == robot.joints() && robot.transmission.cols() == robot.joints();
}

bool is_valid(const JointDynamics& dynamics) {
  const double sum =
      dynamics.viscous + dynamics.coulomb + dynamics.rotor_inertia + dynamics.backlash;
  return std::isfinite(sum) && dynamics.viscous >= 0 && dynamics.coulomb >= 0 &&
         dynamics.rotor_inertia >= 0 && dynamics.backlash >= 0;
}

void refuse_impossible(const Robot& robot) {
  bool valid = has_joints(robot) && is_transmission(robot.transmission) &&
               validate(robot.elastic) == Result::ok && has_plausible_springs(robot.elastic) &&
               !robot.name.empty() && printable_line(robot.name) == robot.name;
  for (const JointDynamics& dynamics : robot.dynamics) {
    valid = valid && is_valid(dynamics);
  }
  if (!valid) {
    throw std::invalid_argument("a robot that cannot be is not written");
  }
}

std::string relative_urdf(const std::filesystem::path& file, const Robot& robot) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(file, error).parent_path();
  const std::filesystem::path relative = std::filesystem::proximate(robot.urdf, folder, error);
  if (error) {
    throw InputError(fmt::format("{}: cannot be reached from {}: {}", robot.urdf.string(),
                                 folder.string(), error.message()));
  }
  return relative.string();
}

}  // namespace

bool is_transmission(const JointMatrix& transmission) {
  constexpr double kSmallest = 1e-6;  // of the largest singular value
  const Eigen::JacobiSVD<JointMatrix> svd(transmission);
  return transmission.allFinite() &&
         svd.singularValues().minCoeff() > kSmallest * svd.singularValues()[0];
}

std::string robot_text(const std::filesystem::path& file, const Robot& robot) {
  refuse_impossible(robot);
  return document(robot, relative_urdf(file, robot));
}

void write_robot(const std::filesystem::path& file, const Robot& robot) {
  files::write_text(file, robot_text(file, robot));
}

}  // namespace flexcomp::model
