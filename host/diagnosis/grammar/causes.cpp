#include "diagnosis/grammar/causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "effects/formula_law.hpp"

namespace flexcomp::diagnosis::grammar {
namespace {

using effects::PlaceKind;
using effects::SignalKind;

bool is_friction(const Lead& lead) {
  return !lead.factor.text.empty() && lead.factor.text.find('v') != std::string::npos;
}

std::string cause_of_friction(SignalKind kind) {
  switch (kind) {
    case SignalKind::angle:
      return "usually friction that is not the same all around: a worn gear, bearing or seal";
    case SignalKind::temperature:
    case SignalKind::time:
      return "usually grease that warms";
    case SignalKind::speed:
      return "usually drag of grease, oil or air";
    default:
      return "usually friction under load";
  }
}

/// Has a shape waves of an order that the recordings tell, as teeth and magnets have?
bool is_ripple(const Shape& shape) {
  return std::any_of(shape.parameters.begin(), shape.parameters.end(),
                     [](const ShapeParameter& each) { return each.sought == Sought::wave; });
}

std::string cause_of_torque(const Lead& lead, const Shape& shape) {
  if (is_friction(lead)) {
    return cause_of_friction(lead.driver->kind);
  }
  if (lead.driver->kind == SignalKind::angle && is_ripple(shape)) {
    return "usually the magnets of a motor or the teeth of a gear";
  }
  switch (lead.driver->kind) {
    case SignalKind::angle:
      return lead.driver->joint == lead.seat->place.joint
                 ? "usually a spring, a stop or a dress pack"
                 : "usually a cable or hose";
    case SignalKind::speed:
      return lead.driver->is_product ? "usually a mass that both joints move"
                                     : "usually drag of grease, oil or air";
    case SignalKind::torque:
    case SignalKind::load:
      return "usually a drive or its current sensor that is not linear";
    case SignalKind::temperature:
    case SignalKind::time:
      return "usually a drive that warms";
    default:
      return "";
  }
}

std::string cause_of_angle(const Lead& lead) {
  const bool is_own = lead.driver->joint == lead.seat->place.joint;
  switch (lead.driver->kind) {
    case SignalKind::angle:
      return is_own ? "usually a fault of the gear or the encoder"
                    : "usually gears that are coupled";
    case SignalKind::torque:
    case SignalKind::load:
    case SignalKind::wrench:
    case SignalKind::tool_wrench:
      return "usually a bearing, a housing or a gear that gives";
    case SignalKind::temperature:
    case SignalKind::time:
      return "usually a part that warms";
    default:
      return "";
  }
}

std::string cause_at_tcp(const Lead& lead) {
  switch (lead.driver->kind) {
    case SignalKind::wrench:
    case SignalKind::tool_wrench:
    case SignalKind::load:
      return "usually a structure that gives";
    case SignalKind::temperature:
      return "usually a structure that warms";
    default:
      return "";
  }
}

std::string cause_of_event(const Shape& shape) {
  return shape.trait == ShapeTrait::shift
             ? "usually somebody or something that moved a part; no signal that was recorded shows "
               "it"
             : "usually a machine nearby; no signal that was recorded shows it";
}

/// Value of a parameter by its name; not a number where there is none.
double value_of(const Chosen& law, const std::string& name) {
  for (std::size_t i = 0; i < law.values.size(); ++i) {
    if (law.hypothesis.parameters[i].name == name) {
      return law.values[i];
    }
  }
  return std::nan("");
}

}  // namespace

std::string usual_cause(const Lead& lead, const Shape& shape) {
  if (lead.seat->is_sensor()) {
    return cause_of_event(shape);
  }
  switch (lead.seat->place.kind) {
    case PlaceKind::joint_torque:
      return cause_of_torque(lead, shape);
    case PlaceKind::joint_angle:
      return cause_of_angle(lead);
    case PlaceKind::sensor_wrench:
      return "usually a force sensor that is not linear, or whose axes are not apart";
    default:
      return cause_at_tcp(lead);
  }
}

std::string next_recording(const Chosen& law) {
  const auto& bound = law.hypothesis.law->bound;
  if (!bound || effects::moves_the_robot(bound->place) || !bound->follows(SignalKind::time)) {
    return "";
  }
  const double order = value_of(law, "k");
  return std::isfinite(order)
             ? fmt::format(
                   "Record with an accelerometer on the floor and one on the base: no signal that "
                   "was recorded drives the tone of {:.3g} Hz.",
                   std::abs(order) / (2 * M_PI))
             : fmt::format(
                   "Record with a second target on the base: no signal that was recorded shows "
                   "what moved at {:.4g} s.",
                   value_of(law, "d"));
}

}  // namespace flexcomp::diagnosis::grammar
