#include "check/model_checks.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "check/arm.hpp"
#include "effects/law.hpp"
#include "effects/machine_size.hpp"

namespace flexcomp::check {
namespace {

constexpr double kLeastWindup = 1e-4;  // rad, under the largest torque
constexpr double kMostWindup = 0.15;

Check said_of_model(Severity severity, const char* name, const model::Robot& robot,
                    const std::string& what, const char* fix) {
  return {severity, "model", name, robot.yaml.string() + ": " + what, fix};
}

Checks check_springs(const model::Robot& robot) {
  Checks checks;
  for (Eigen::Index joint = 0; joint < joint_count(robot); ++joint) {
    const auto at = static_cast<std::size_t>(joint);
    const double effort = robot.dynamics[at].effort;
    const double compliance = joint_of(robot, joint).compliance;
    const double windup = compliance * effort;
    // A joint that does not give at all is a choice, not a slip.
    if (!turns(robot, joint) || compliance == 0 || effort <= 0 ||
        (windup >= kLeastWindup && windup <= kMostWindup)) {
      continue;
    }
    checks.push_back(said_of_model(
        Severity::warning, "compliance.size", robot,
        fmt::format(
            "joints.{}.compliance: {:g} rad/(N·m) is unusually {}: under its largest torque "
            "of {:g} N·m the joint would give {:.2g} mrad, where robots of any size give "
            "0.1 to 150",
            robot.joint_names[at], compliance, windup > kMostWindup ? "soft" : "stiff", effort,
            1e3 * windup),
        "give compliance (not stiffness) in rad/(N·m) on the joint side, and effort in the URDF in "
        "N·m"));
  }
  return checks;
}

/// Base and tool under the weight of the arm.
Checks check_structure(const model::Robot& robot, const effects::MachineSize& size) {
  constexpr double kMostSag = 0.05;  // m
  const std::pair<const char*, double> springs[] = {
      {"base_compliance", robot.elastic.base_compliance.head<3>().maxCoeff()},
      {"tool_compliance", robot.elastic.tool_compliance.head<3>().maxCoeff()}};
  Checks checks;
  for (const auto& [key, compliance] : springs) {
    if (compliance * size.weight > kMostSag) {
      checks.push_back(said_of_model(
          Severity::warning, "compliance.size", robot,
          fmt::format(
              "{}: {:g} m/N is unusually soft: the arm's own weight would move it by {:.2g} "
              "mm",
              key, compliance, 1e3 * compliance * size.weight),
          "give compliance in m/N, three numbers, then in rad/(N·m), three"));
    }
  }
  return checks;
}

Checks check_gravity(const model::Robot& robot) {
  constexpr double kLeastGravity = 9.7;  // m/s², on earth
  constexpr double kMostGravity = 9.9;
  const double gravity = robot.elastic.gravity.norm();
  Checks checks;
  if (gravity > 0 && (gravity < kLeastGravity || gravity > kMostGravity)) {
    checks.push_back(
        said_of_model(Severity::warning, "gravity.size", robot,
                      fmt::format("gravity: {:g} m/s² is not that of the earth", gravity),
                      "give gravity in m/s², 9.81 in all, or zero to leave weight out"));
  }
  if (gravity == 0 && robot.elastic.payload_mass > 0) {
    checks.push_back(
        said_of_model(Severity::warning, "gravity.missing", robot,
                      fmt::format("payload.mass: {:g} kg have no weight, because gravity is zero",
                                  robot.elastic.payload_mass),
                      "set gravity to [0, 0, -9.81], in the base frame, or leave the payload out"));
  }
  if (gravity > 0 && !has_masses(robot)) {
    checks.push_back(said_of_model(
        Severity::warning, "masses.missing", robot,
        "gravity: the arm has no weight, because no link of the URDF has a mass",
        "give the links their <inertial> in the URDF, or set gravity to zero to leave weight out"));
  }
  return checks;
}

/// A tool axis as of ROS-Industrial's frame `flange`, and of some makers' `tool0`: x points out of
/// the flange. A spindle may be mounted so on purpose; a tool that is turned is.
Checks check_tool_axis(const model::Robot& robot) {
  constexpr double kAlong = 0.99;
  const auto& last = robot.elastic.joints.back();
  const Vector3<double> in_tool = robot.elastic.tool.rotation.transpose() * last.axis;
  const bool is_turned = robot.tool && robot.tool->rpy != std::array<double, 3>{};
  if (is_turned || last.slides() || std::abs(in_tool.x()) < kAlong) {
    return {};
  }
  return {said_of_model(
      Severity::note, "tool.axis", robot,
      fmt::format("tool_link: x of '{}' points along the last joint's axis, and z across it; "
                  "programs take z for the direction out of the tool into the work",
                  robot.tool_link),
      "give the tool with its turn, as tool: {xyz: [0.25, 0, 0], rpy: [0, 1.5707963, 0]}")};
}

Checks check_tool_size(const model::Robot& robot, const effects::MachineSize& size) {
  constexpr double kLongest = 0.5;  // of the reach
  Checks checks;
  const auto warn_if_far = [&](const char* name, const char* of, const char* key, double length,
                               const char* what, const char* fix) {
    if (length >= kLongest * size.reach) {
      checks.push_back(said_of_model(
          Severity::warning, name, robot,
          fmt::format("{}.{}: {} stands {:g} m off, which is as far as the arm reaches", of, key,
                      what, length),
          fix));
    }
  };
  if (robot.tool) {
    warn_if_far("tool.size", "tool", "xyz", Vector3<double>(robot.tool->xyz.data()).norm(),
                "the TCP", "give xyz in metres, in the frame of tool_link");
    warn_if_far("tool.size", "tool", "com", Vector3<double>(robot.tool->com.data()).norm(),
                "the tool's centre of mass", "give com in metres, in the frame of tool_link");
  }
  warn_if_far("payload.size", "payload", "com", robot.elastic.payload_center.norm(),
              "the payload's centre of mass", "give com in metres, in the tool frame");
  return checks;
}

/// What hangs on the flange against the arm that carries it. The tool is part of the last link.
Checks check_load(const model::Robot& robot, const effects::MachineSize& size) {
  const double tool = robot.tool ? robot.tool->mass : 0;
  const double arm = size.weight / effects::kGravity - tool;
  const double most = has_masses(robot) ? arm : effects::kLargestPayload;
  const std::string than = has_masses(robot)
                               ? fmt::format("the arm's own {:.4g} kg", most)
                               : fmt::format("the {:g} kg that the strongest arm carries", most);
  Checks checks;
  for (const auto& [key, mass] :
       {std::pair{"payload", robot.elastic.payload_mass}, std::pair{"tool", tool}}) {
    if (mass > most) {
      checks.push_back(
          said_of_model(Severity::warning, "payload.size", robot,
                        fmt::format("{}.mass: {:g} kg is more than {}", key, mass, than),
                        "give the mass in kg; masses of the links stand in the URDF"));
    }
  }
  return checks;
}

/// Effects that the robot lists, far from what machines have.
Checks check_effects(const model::Robot& robot, const effects::MachineSize& size) {
  Checks checks;
  for (std::size_t i = 0; i < robot.effects.size(); ++i) {
    const model::LearnedEffect& effect = robot.effects[i];
    const effects::LawPointer law = effects::find_law(effect.effect, effect.form);
    if (!law) {
      continue;  // a formula: its ranges are its writer's
    }
    for (const auto& [name, value] : effect.parameters) {
      const effects::Range range = effects::plausible_range(*law, robot, size, effect.joint, name);
      if (value < range.lower || value > range.upper) {
        checks.push_back(said_of_model(
            Severity::warning, "effect.size", robot,
            fmt::format("effects[{}].{}: {:g} of {} lies beyond {:.3g} to {:.3g} ({})", i, name,
                        value, effect.effect, range.lower, range.upper, range.source),
            "give SI units: m, rad, N, N·m"));
      }
    }
  }
  return checks;
}

}  // namespace

Checks check_model(const model::Robot& robot) {
  const effects::MachineSize size = effects::size_of(robot);
  Checks checks = check_springs(robot);
  add(check_structure(robot, size), &checks);
  add(check_gravity(robot), &checks);
  add(check_tool_axis(robot), &checks);
  add(check_tool_size(robot, size), &checks);
  add(check_effects(robot, size), &checks);
  add(check_load(robot, size), &checks);
  return checks;
}

}  // namespace flexcomp::check
