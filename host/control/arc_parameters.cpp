#include "control/arc_parameters.hpp"

#include <fmt/format.h>

#include <functional>

#include "error.hpp"
#include "files/text_file.hpp"
#include "model/yaml_map.hpp"

namespace flexcomp::control {
namespace {

using SixJointGains = ArcGains<double, 6>;
using JointRow = JointVector<double, 6>;

/// Visits every gain by its name, in the order of the C structure: numbers, vectors, matrices.
template <typename GainsType, typename Visitor>
void visit(GainsType* gains, Visitor&& visitor) {
  visitor("period", &gains->period);
  visitor("rotor_inertia", &gains->rotor_inertia);
  visitor("viscous", &gains->viscous);
  visitor("link_rate", &gains->link_rate);
  visitor("link_damping", &gains->link_damping);
  visitor("motor_rate", &gains->motor_rate);
  visitor("motor_damping", &gains->motor_damping);
  visitor("motor_stiffness", &gains->motor_stiffness);
  visitor("filter_frequency", &gains->filter_frequency);
  visitor("leak", &gains->leak);
  visitor("link_adaptation", &gains->link_adaptation);
  visitor("motor_adaptation", &gains->motor_adaptation);
  visitor("link_gain", &gains->link_gain);
  visitor("motor_gain", &gains->motor_gain);
  visitor("link_gain_limit", &gains->link_gain_limit);
  visitor("motor_gain_limit", &gains->motor_gain_limit);
  visitor("link_bound_limit", &gains->link_bound_limit);
  visitor("motor_bound_limit", &gains->motor_bound_limit);
  visitor("torque_limit", &gains->torque_limit);
}

/// The shortest text that reads back as the same number, in YAML 1.1 and C too.
std::string number(double value) {
  std::string text = fmt::format("{}", value);
  const std::size_t exponent = text.find('e');
  if (text.find('.') == std::string::npos) {
    text.insert(exponent == std::string::npos ? text.size() : exponent, ".0");
  }
  return text;
}

template <typename Derived>
std::string row(const Eigen::MatrixBase<Derived>& values, const char* unit = "") {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    text += (i > 0 ? ", " : "") + number(values(i)) + unit;
  }
  return text;
}

struct YamlWriter {
  std::string* text;

  void operator()(const char* name, const double* value) const {
    *text += fmt::format("  {}: {}\n", name, number(*value));
  }
  void operator()(const char* name, const JointRow* values) const {
    *text += fmt::format("  {}: [{}]\n", name, row(*values));
  }
  template <int Columns>
  void operator()(const char* name, const Eigen::Matrix<double, 6, Columns>* values) const {
    *text += fmt::format("  {}: [{}]  # {} a joint\n", name, row(values->transpose().reshaped()),
                         Columns);
  }
};

struct YamlReader {
  const model::YamlMap* yaml;

  void operator()(const char* name, double* value) const { *value = yaml->number(name); }
  template <int Columns>
  void operator()(const char* name, Eigen::Matrix<double, 6, Columns>* values) const {
    const auto list = yaml->numbers<static_cast<std::size_t>(6 * Columns)>(name);
    *values = Eigen::Map<const Eigen::Matrix<double, Columns, 6>>(list.data()).transpose();
  }
};

struct HeaderWriter {
  std::string* text;

  void operator()(const char* name, const double* value) const {
    *text += fmt::format("    .{} = {}f,\n", name, number(*value));
  }
  void operator()(const char* name, const JointRow* values) const {
    *text += fmt::format("    .{} = {{{}}},\n", name, row(*values, "f"));
  }
  template <int Columns>
  void operator()(const char* name, const Eigen::Matrix<double, 6, Columns>* values) const {
    *text += fmt::format("    .{} = {{", name);
    for (Eigen::Index i = 0; i < 6; ++i) {
      *text += fmt::format("{}{{{}}}", i > 0 ? ", " : "", row(values->row(i), "f"));
    }
    *text += "},\n";
  }
};

}  // namespace

ArcParameters arc_parameters(const simulation::FlexibleArm<6>& arm, const SixJointGains& gains) {
  return {gains, model_hash(arm.model), arm.model.gravity, arm.model.payload_mass,
          arm.model.payload_center};
}

void write_arc_parameters(const std::filesystem::path& file, const ArcParameters& parameters) {
  std::string text = fmt::format(
      "# Adaptive robust control: made by flexcomp design-arc. Units: flexcomp/arc.hpp.\n"
      "schema: flexcomp/arc/1\nmodel_hash: \"{:016x}\"\ngravity: [{}]\n"
      "payload: {{mass: {}, com: [{}]}}\ngains:\n",
      parameters.model_hash, row(parameters.gravity), number(parameters.payload_mass),
      row(parameters.payload_center));
  visit(&parameters.gains, YamlWriter{&text});
  files::write_text(file, text);
}

ArcParameters read_arc_parameters(const std::filesystem::path& file) {
  const model::YamlMap yaml = model::load_yaml(file);
  if (yaml.text("schema") != "flexcomp/arc/1") {
    yaml.refuse("schema", "expected flexcomp/arc/1");
  }
  yaml.allow_only({"schema", "model_hash", "gravity", "payload", "gains"});
  ArcParameters parameters;
  const std::string hash = yaml.text("model_hash");
  if (hash.size() != 16 || hash.find_first_not_of("0123456789abcdef") != std::string::npos) {
    yaml.refuse("model_hash", "expected 16 hexadecimal digits");
  }
  parameters.model_hash = std::stoull(hash, nullptr, 16);
  const auto gravity = yaml.numbers<3>("gravity");
  parameters.gravity = {gravity[0], gravity[1], gravity[2]};
  const model::YamlMap payload = yaml.map("payload");
  payload.allow_only({"mass", "com"});
  parameters.payload_mass = payload.non_negative("mass");
  const auto center = payload.numbers<3>("com");
  parameters.payload_center = {center[0], center[1], center[2]};
  const model::YamlMap gains = yaml.map("gains");
  std::vector<std::string> names;
  visit(&parameters.gains, [&](const char* name, const auto*) { names.emplace_back(name); });
  gains.allow_only(names);
  visit(&parameters.gains, YamlReader{&gains});
  return parameters;
}

AdaptiveRobustController<double, 6> make_controller(const ArcParameters& parameters,
                                                    simulation::FlexibleArm<6> arm) {
  arm.model.gravity = parameters.gravity;
  arm.model.payload_mass = parameters.payload_mass;
  arm.model.payload_center = parameters.payload_center;
  if (model_hash(arm.model) != parameters.model_hash) {
    throw InputError("the controller's parameters were made for another robot or tool");
  }
  AdaptiveRobustController<double, 6> controller;
  const Result result = controller.configure(arm.model, arm.inertia, parameters.gains);
  if (result != Result::ok) {
    throw InputError(fmt::format("the controller refuses its parameters: {}", describe(result)));
  }
  return controller;
}

std::string c_header(const ArcParameters& parameters, const std::string& robot) {
  std::string text = fmt::format(
      "/* Adaptive robust control of {}, model {:016x}: made by flexcomp design-arc. */\n"
      "#ifndef ARC_GAINS_H\n#define ARC_GAINS_H\n\n#include \"flexcomp/flexcomp.h\"\n\n"
      "static const flexcomp_arc_gains_t arc_gains = {{\n",
      robot, parameters.model_hash);
  visit(&parameters.gains, HeaderWriter{&text});
  return text + "};\n\n#endif\n";
}

}  // namespace flexcomp::control
