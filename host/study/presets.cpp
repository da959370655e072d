#include "study/presets.hpp"

#include <cmath>

#include "error.hpp"

namespace flexcomp::study {
namespace {

MilledCircle strict() { return {}; }

MilledCircle flange() {
  MilledCircle circle;
  circle.force = {1104, 0, 0};
  circle.point = ToolPoint::tcp;
  return circle;
}

MilledCircle counter() {
  MilledCircle circle;
  circle.sense = WrenchSense::against_path;
  circle.is_first_order = true;
  return circle;
}

}  // namespace

double study_force() { return MilledCircle{}.force.norm(); }

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"strict", strict()}, {"flange", flange()}, {"counter", counter()}};
  return all;
}

const Preset& preset(const std::string& name) {
  for (const Preset& each : presets()) {
    if (each.name == name) {
      return each;
    }
  }
  throw InputError("no preset " + name);
}

double counter_middle(const PlanarArm& arm, const MilledCircle& circle) {
  const double least = arm.reach[0];
  const double most = arm.reach[1];
  const double mean_square = (std::pow(most, 3) - std::pow(least, 3)) / (3 * (most - least));
  return std::hypot(circle.force[0], circle.force[1]) *
         (arm.compliance[0] * mean_square + arm.compliance[1] * std::norm(arm.forearm) +
          arm.compliance[2] * std::norm(arm.wrist_to_tool));
}

}  // namespace flexcomp::study
