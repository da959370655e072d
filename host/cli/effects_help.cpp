#include "cli/effects_help.hpp"

#include <fmt/format.h>

#include "effects/law.hpp"
#include "model/robot.hpp"

namespace flexcomp::cli {
namespace {

/// A machine of six joints that turn about z and stand one above the other: what effects say of any
/// machine, they say of it.
model::Robot upright_robot() {
  model::Robot robot;
  robot.set_joints(6);
  robot.elastic.gravity = {0, 0, -9.81};
  for (model::ChainJoint& joint : robot.elastic.joints) {
    joint.axis = Vector3<double>::UnitZ();
    joint.origin.position = Vector3<double>::UnitZ();
  }
  return robot;
}

/// "sine (N·m), cosine (N·m), order": a number without a unit has none.
std::string parameters_of(const effects::Law& law, const model::Robot& robot, int joint) {
  std::string text;
  for (const effects::Parameter& each : law.parameters(robot, joint)) {
    text += text.empty() ? "" : ", ";
    text += each.unit.empty() || each.unit == "1" ? each.name
                                                  : fmt::format("{} ({})", each.name, each.unit);
  }
  return text;
}

std::string form_text(const effects::Law& law, const model::Robot& robot) {
  const int joint = law.joints(robot.joints()).front();
  const std::string form = law.form.empty() ? "" : "form: " + law.form + "; ";
  return fmt::format("    {}{}{}\n", joint > 0 ? "joint; " : "", form,
                     parameters_of(law, robot, joint));
}

/// What a law says of joint 1, said of joint N.
std::string statement_of(const effects::Law& law, int joint) {
  std::string text = law.statement(joint);
  const std::string own = fmt::format("joint {}", joint);
  const std::size_t found = text.find(own);
  return joint == 0 || found == std::string::npos ? text
                                                  : text.replace(found, own.size(), "joint N");
}

std::string text_of(const effects::Effect& effect, const model::Robot& robot) {
  const effects::Law& first = *effect.forms.front();
  std::string text = fmt::format("\n{}: {}\n", effect.name,
                                 statement_of(first, first.joints(robot.joints()).front()));
  for (const effects::LawPointer& law : effect.forms) {
    text += form_text(*law, robot);
  }
  return text;
}

}  // namespace

std::string effects_help(const std::string& name) {
  const model::Robot robot = upright_robot();
  std::string found;
  for (const effects::Effect& effect : effects::catalogue()) {
    if (name.empty() || name == effect.name) {
      found += text_of(effect, robot);
    }
  }
  constexpr const char* kBefore =
      "Effects of robot.yaml, as a diagnosis finds them and `effects:` takes them:\n\n"
      "  effects:\n"
      "    - {effect: torque_ripple, joint: 3, sine: 1.5, cosine: -0.4, order: 12}\n\n"
      "Below each stand the keys that it takes. Joints count from 1. Of a joint that slides rad is "
      "m and\nN·m is N. `order` counts periods in a turn of the joint. Where keys are of two axes "
      "only, these lie\nacross the joint's own axis or across its link; here both are along z. Of "
      "the effect `law`\nhost/README.md says all.\n";
  return found.empty() ? found : kBefore + found;
}

}  // namespace flexcomp::cli
