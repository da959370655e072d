#include <algorithm>
#include <cmath>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kFarthest = 0.5;      // of the reach, from the flange
constexpr double kLeastPayload = 0.1;  // kg

/// How far its first moment is beyond that of its mass at the farthest place.
Eigen::VectorXd too_far(const model::Robot& /*model*/, const model::Robot& altered,
                        const MachineSize& size, int /*joint*/, double margin) {
  const double mass = altered.elastic.payload_mass;
  const double farthest = kFarthest * size.reach;
  const double excess = (std::abs(mass) * altered.elastic.payload_center.norm() - mass * farthest) /
                        (std::max(std::abs(mass), kLeastPayload) * farthest);
  return Eigen::VectorXd::Constant(1, std::max(excess + margin, 0.0));
}

}  // namespace

// Mass on the flange that differs from the model's, as a point: mass and first moment in the tool
// frame (rigid-body dynamics).
Forms laws::payload() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 4;
  law.traits.is_in_family = true;
  law.traits.is_body = true;
  law.traits.tells_inertia = true;
  law.excess = too_far;
  law.no_body =
      "a payload without mass or farther from the flange than half of the reach cannot be";
  law.parameters = constant({{"mass", "kg"}, {"mx", "kg·m"}, {"my", "kg·m"}, {"mz", "kg·m"}});
  law.statement = says("the mass on the flange is another");
  alter_keys(
      [](const Values& values, int, model::Robot* whole) {
        model::Chain& robot = whole->elastic;
        const Vector3<double> moment = robot.payload_mass * robot.payload_center +
                                       Vector3<double>(values[1], values[2], values[3]);
        robot.payload_mass += values[0];
        robot.payload_center = std::abs(robot.payload_mass) > 1e-3
                                   ? Vector3<double>(moment / robot.payload_mass)
                                   : Vector3<double>::Zero();
      },
      &law);
  return {{law},
          {},
          {{"", " mass ",
            [](const Subject& of) {
              const double known = of.robot.elastic.payload_mass;
              return Range{-known, of.size.payload - known};
            },
            "data sheets: no arm carries more than it moves of itself, and no mass is negative"},
           {"", " mx my mz ",
            [](const Subject& of) { return within(kFarthest * of.size.payload * of.size.reach); },
            "what the flange carries lies within half of the arm's reach from it"}}};
}

}  // namespace flexcomp::effects
