#include "model/c_model.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cctype>

#include "flexcomp/model.hpp"

namespace flexcomp::model {
namespace {

/// A literal of type float that a compiler reads as this very number.
std::string literal(float number) {
  std::string text = fmt::format("{:.9g}", number);
  if (text.find_first_of(".e") == std::string::npos) {
    text += ".0";
  }
  return text + "f";
}

template <typename Derived>
std::string list(const Eigen::MatrixBase<Derived>& numbers) {
  std::string text;
  for (Eigen::Index row = 0; row < numbers.rows(); ++row) {
    for (Eigen::Index column = 0; column < numbers.cols(); ++column) {
      text += (text.empty() ? "" : ", ") + literal(numbers(row, column));
    }
  }
  return "{" + text + "}";
}

std::string braces(const Pose<float>& pose) {
  return fmt::format("{{{}, {}}}", list(pose.rotation), list(pose.position));
}

/// A URDF's name may hold whatever ends a comment.
std::string comment(const std::string& name) {
  const auto is_plain = [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '_' || letter == '-';
  };
  return std::all_of(name.begin(), name.end(), is_plain) ? fmt::format(" /* {} */", name) : "";
}

std::string braces(const Joint<float>& joint) {
  return fmt::format("{{{},\n     {}, {}, {}, {}, {},\n     {}, {}, {}}}", braces(joint.origin),
                     list(joint.axis), literal(joint.lower), literal(joint.upper),
                     literal(joint.compliance), literal(joint.cubic_compliance),
                     list(joint.link_compliance), literal(joint.mass), list(joint.center_of_mass));
}

}  // namespace

std::string c_model_text(const Robot& robot) {
  const RobotModel<float, 6> model = six_axis_model(robot).cast<float>();
  std::string joints;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    joints += fmt::format("    {}{}{}\n", braces(model.joints[i]),
                          i + 1 < model.joints.size() ? "," : "", comment(robot.joint_names[i]));
  }
  return fmt::format(
      "/* A robot for the core, made by flexcomp configure --c-model; the order is that of\n"
      "   flexcomp_model_t. Make it anew when robot.yaml or its URDF changes. */\n"
      "#pragma once\n\n#include <flexcomp/flexcomp.h>\n\n"
      "/* Ties tables to this robot, tool and payload: flexcomp_model_hash(&robot_model). */\n"
      "#define ROBOT_MODEL_HASH UINT64_C(0x{:016x})\n\n"
      "static const flexcomp_model_t robot_model = {{\n  {{\n{}  }},\n  {},\n  {},\n  {},\n  {},\n"
      "  {},\n  {}\n}};\n",
      model_hash(model), joints, braces(model.tool), list(model.base_compliance),
      list(model.tool_compliance), list(model.gravity), literal(model.payload_mass),
      list(model.payload_center));
}

}  // namespace flexcomp::model
