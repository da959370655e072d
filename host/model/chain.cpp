#include "model/chain.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace flexcomp::model {
namespace {

template <typename From, typename To>
void copy_all_but_joints(const From& from, To* to) {
  to->tool = from.tool;
  to->base_compliance = from.base_compliance;
  to->tool_compliance = from.tool_compliance;
  to->gravity = from.gravity;
  to->payload_mass = from.payload_mass;
  to->payload_center = from.payload_center;
}

/// A model of the core with one joint of a chain in the place of all.
RobotModel<double, 1> around(const Chain& chain, const ChainJoint& joint) {
  RobotModel<double, 1> model;
  model.joints[0] = joint;
  copy_all_but_joints(chain, &model);
  return model;
}

}  // namespace

const char* name_of(JointType type) {
  switch (type) {
    case JointType::continuous:
      return "continuous";
    case JointType::prismatic:
      return "prismatic";
    case JointType::revolute:
      break;
  }
  return "revolute";
}

Result validate(const Chain& chain) {
  const bool valid = !chain.joints.empty() &&
                     std::all_of(chain.joints.begin(), chain.joints.end(), [&](const auto& joint) {
                       return flexcomp::validate(around(chain, joint)) == Result::ok;
                     });
  return valid ? Result::ok : Result::bad_model;
}

bool has_structure_springs(const Chain& chain) {
  return !chain.base_compliance.isZero(0) || !chain.tool_compliance.isZero(0) ||
         std::any_of(chain.joints.begin(), chain.joints.end(),
                     [](const auto& joint) { return !joint.link_compliance.isZero(0); });
}

std::optional<RobotModel<double, 6>> six_axis_model(const Chain& chain) {
  RobotModel<double, 6> model;
  const bool fits = chain.joints.size() == model.joints.size() &&
                    std::all_of(chain.joints.begin(), chain.joints.end(), [](const auto& joint) {
                      return joint.type == JointType::revolute;
                    });
  if (!fits) {
    return std::nullopt;
  }
  std::copy(chain.joints.begin(), chain.joints.end(), model.joints.begin());
  copy_all_but_joints(chain, &model);
  return model;
}

Chain chain_of(const RobotModel<double, 6>& model) {
  Chain chain;
  for (const Joint<double>& joint : model.joints) {
    chain.joints.push_back({joint, JointType::revolute});
  }
  copy_all_but_joints(model, &chain);
  return chain;
}

std::string unit_of(const Chain& chain, const std::string& of_turning) {
  const auto slides = [](const ChainJoint& joint) { return joint.slides(); };
  const auto first = std::find_if(chain.joints.begin(), chain.joints.end(), slides);
  if (first == chain.joints.end()) {
    return of_turning;
  }
  const std::string of_sliding = unit_of(*first, of_turning);
  const bool all_slide = std::all_of(chain.joints.begin(), chain.joints.end(), slides);
  return all_slide || of_sliding == of_turning ? of_sliding : of_turning + " or " + of_sliding;
}

std::string unit_of(const ChainJoint& joint, const std::string& of_turning) {
  using Pair = std::pair<std::string_view, std::string_view>;
  static constexpr std::array<Pair, 10> kUnits = {{{"rad", "m"},
                                                   {"rad/s", "m/s"},
                                                   {"rad/s^2", "m/s^2"},
                                                   {"N·m", "N"},
                                                   {"N·m·s/rad", "N·s/m"},
                                                   {"N·m/rad", "N/m"},
                                                   {"rad/(N·m)", "m/N"},
                                                   {"rad/(N·m)^3", "m/N^3"},
                                                   {"kg·m^2", "kg"},
                                                   {"1/rad", "1/m"}}};
  const auto* const found = std::find_if(
      kUnits.begin(), kUnits.end(), [&](const Pair& unit) { return unit.first == of_turning; });
  return joint.slides() && found != kUnits.end() ? std::string(found->second) : of_turning;
}

}  // namespace flexcomp::model
