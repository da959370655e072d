#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Range base_shift(const Subject& of) {
  const auto axis = static_cast<Eigen::Index>(of.parameter.back() - 'x');
  return change(
      of.robot.elastic.base_compliance[axis],
      softest(kMostShift, kShiftOfReach * of.size.reach, std::max(of.size.weight, of.size.force)));
}

Range base_turn(const Subject& of) {
  const auto axis = static_cast<Eigen::Index>(3 + of.parameter.back() - 'x');
  return change(
      of.robot.elastic.base_compliance[axis],
      softest(kMostTurn, kSpringTurn, std::max(0.5 * of.size.weight_torque, of.largest_load())));
}

}  // namespace

// The foundation or pedestal gives: a diagonal spring at the base frame (Klimchik et al. 2017).
Forms laws::base_compliance() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 6;
  law.traits.is_in_family = true;
  law.parameters = constant({{"x", "m/N"},
                             {"y", "m/N"},
                             {"z", "m/N"},
                             {"rx", "rad/(N·m)"},
                             {"ry", "rad/(N·m)"},
                             {"rz", "rad/(N·m)"}});
  law.statement = says("the base gives");
  alter_keys(
      [](const Values& values, int, model::Robot* robot) {
        robot->elastic.base_compliance += Eigen::Map<const Twist<double>>(values.data());
      },
      &law);
  return {{law},
          {},
          {{"", " x y z ", base_shift,
            "a foundation that gives by a twentieth of the reach under the arm's weight holds no "
            "robot"},
           {"", " rx ry rz ", base_turn,
            "a foundation that tips by 0.1 rad under the arm's weight holds no robot"}}};
}

}  // namespace flexcomp::effects
