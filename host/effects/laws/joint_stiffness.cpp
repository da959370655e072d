#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

constexpr double kSmallestShare = 0.01;  // of a spring's compliance, of one in the other

Range joint_spring(const Subject& of) {
  const double known = of.joint().compliance;
  const double most = of.joint().slides()
                          ? softest(kMostShift, kShiftOfReach * of.size.reach, of.load())
                          : softest(kMostTurn, kSpringTurn, of.load());
  if (!(known > 0)) {
    return up_to(most);
  }
  return {(kSmallestShare - 1) * known, std::min(most, known / kSmallestShare) - known};
}

}  // namespace

// Linear compliance of a joint that differs from the model's: it winds up by more or less per
// torque (virtual-joint model, Klimchik et al. 2017).
Forms laws::joint_stiffness() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_in_family = true;
  law.traits.is_model_number = true;
  law.traits.measures = Measures::stiffness;
  law.parameters = of_joint({{"compliance_change", "rad/(N·m)"}});
  law.words = "stiffness";
  law.statement = says("the spring of joint {} has another stiffness");
  law.derived = [](const model::Robot& robot, int joint, const Values& values) {
    const model::ChainJoint& at = robot.elastic.joints[index_of(joint)];
    return std::vector<Derived>{
        {"compliance", model::unit_of(at, "rad/(N·m)"), at.compliance + values[0], 0}};
  };
  alter_keys(
      [](const Values& values, int joint, model::Robot* robot) {
        robot->elastic.joints[index_of(joint)].compliance += values[0];
      },
      &law);
  return {{law},
          {},
          {{"", " compliance_change ", joint_spring,
            "no gear is rigid, none a hundred times softer than was measured of its kind, and none "
            "winds "
            "up "
            "by 0.1 rad under what it bears (series elastic actuators do, Pratt and Williamson "
            "1995)"}}};
}

}  // namespace flexcomp::effects
