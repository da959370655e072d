#include "diagnosis/grammar/known.hpp"

#include <algorithm>
#include <vector>

namespace flexcomp::diagnosis::grammar {
namespace {

using effects::PlaceKind;
using effects::SignalKind;

/// What an effect of the catalogue says at a joint, by that joint's own signals.
struct Known {
  const char* effect;
  PlaceKind place;
  const char* factor;  ///< a signal of the joint, or its sign; empty: none
  SignalKind driver;
  std::vector<std::string> shapes;
};

const std::vector<Known>& all_known() {
  static const std::vector<std::string> kWaves = {"wave", "wave of any order", "two waves"};
  static const std::vector<Known> kKnown = {
      {"viscous_friction", PlaceKind::joint_torque, "", SignalKind::speed, {"line"}},
      {"coulomb_friction",
       PlaceKind::joint_torque,
       "",
       SignalKind::speed,
       {"sign", "saturation", "slow saturation", "limit", "step", "soft step"}},
      {"stribeck_friction",
       PlaceKind::joint_torque,
       "sign(v",
       SignalKind::speed,
       {"line", "size", "parabola", "saturation", "slow saturation", "limit", "bump", "growth"}},
      {"load_friction",
       PlaceKind::joint_torque,
       "sign(v",
       SignalKind::torque,
       {"size", "line", "square", "signed square"}},
      {"load_friction",
       PlaceKind::joint_torque,
       "sign(v",
       SignalKind::load,
       {"size", "line", "square", "signed square"}},
      {"rotor_inertia", PlaceKind::joint_torque, "", SignalKind::acceleration, {"line"}},
      {"torque_gain", PlaceKind::joint_torque, "", SignalKind::torque, {"line"}},
      {"torque_ripple", PlaceKind::joint_torque, "", SignalKind::angle, kWaves},
      {"transmission", PlaceKind::joint_angle, "", SignalKind::angle, {"line"}},
      {"transmission_ripple", PlaceKind::joint_angle, "", SignalKind::angle, kWaves},
      {"joint_stiffness", PlaceKind::joint_angle, "", SignalKind::load, {"line"}},
      {"joint_stiffness", PlaceKind::joint_angle, "", SignalKind::torque, {"line"}},
      {"nonlinear_stiffness",
       PlaceKind::joint_angle,
       "",
       SignalKind::load,
       {"cube", "odd cubic", "signed square"}},
      {"nonlinear_stiffness",
       PlaceKind::joint_angle,
       "",
       SignalKind::torque,
       {"cube", "odd cubic", "signed square"}}};
  return kKnown;
}

bool begins_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

bool is_drift(const Lead& lead, const Shape& shape) {
  const bool is_tcp =
      lead.seat->place.kind == PlaceKind::tcp_base || lead.seat->place.kind == PlaceKind::tcp_tool;
  const SignalKind kind = lead.driver->kind;
  return is_tcp && lead.factor.text.empty() &&
         ((kind == SignalKind::temperature && std::string("line") == shape.name) ||
          (kind == SignalKind::time &&
           (std::string("approach") == shape.name || std::string("line") == shape.name)));
}

}  // namespace

std::string known_as(const Lead& lead, const Shape& shape) {
  const effects::LawPlace& place = lead.seat->place;
  if (lead.driver->is_power) {
    return "";
  }
  if (place.kind == PlaceKind::sensor_wrench && lead.driver->kind == SignalKind::tool_wrench &&
      std::string("line") == shape.name &&
      lead.driver->name == lead.seat->name.substr(7) + "_tool") {
    return "wrench_scale";
  }
  if (is_drift(lead, shape)) {
    return "thermal_drift";
  }
  for (const Known& each : all_known()) {
    const std::string factor(each.factor);
    const bool same_factor =
        factor.empty() ? lead.factor.text.empty() : begins_with(lead.factor.text, factor);
    if (each.place == place.kind && same_factor && each.driver == lead.driver->kind &&
        lead.driver->joint == place.joint &&
        std::find(each.shapes.begin(), each.shapes.end(), shape.name) != each.shapes.end()) {
      return each.effect;
    }
  }
  return "";
}

}  // namespace flexcomp::diagnosis::grammar
