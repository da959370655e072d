#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Linear compliance of a joint that differs from the model's: it winds up by more or less per
// torque (virtual-joint model, Klimchik et al. 2017).
Forms laws::joint_stiffness() {
  Law law;
  law.joints = joints(1, 6);
  law.traits.linear_in = 1;
  law.traits.is_model_number = true;
  law.traits.measures = Measures::stiffness;
  law.parameters = constant({{"compliance_change", "rad/(N·m)"}});
  law.statement = says("the spring of joint {} has another stiffness");
  law.derived = [](const model::Robot& robot, int joint, const Values& values) {
    const double known = robot.elastic.joints[index_of(joint)].compliance;
    return std::vector<Derived>{{"compliance", "rad/(N·m)", known + values[0], 0}};
  };
  alter_keys(
      [](const Values& values, int joint, model::Robot* robot) {
        robot->elastic.joints[index_of(joint)].compliance += values[0];
      },
      &law);
  return {{law}, {}};
}

}  // namespace flexcomp::effects
