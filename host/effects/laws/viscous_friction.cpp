#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// Friction in proportion to speed, the same both ways or with a coefficient for each (Armstrong-
// Helouvry, Dupont and Canudas de Wit 1994).
Forms laws::viscous_friction() {
  Law both_ways;
  both_ways.joints = every_joint;
  both_ways.traits.linear_in = 1;
  both_ways.traits.is_friction = true;
  both_ways.traits.is_in_family = true;
  both_ways.traits.is_model_number = true;
  both_ways.parameters = of_joint({{"coefficient", "N·m·s/rad"}});
  both_ways.derived = whole_of("whole_coefficient", "N·m·s/rad", &model::JointDynamics::viscous);
  both_ways.statement = says("joint {} has another viscous friction");
  alter_keys([](const Values& values, int joint,
                model::Robot* robot) { robot->dynamics[index_of(joint)].viscous += values[0]; },
             &both_ways);
  Law by_direction;
  by_direction.form = "by_direction";
  by_direction.joints = every_joint;
  by_direction.traits.linear_in = 2;
  by_direction.traits.is_friction = true;
  by_direction.parameters = of_joint({{"forward", "N·m·s/rad"}, {"backward", "N·m·s/rad"}});
  by_direction.statement =
      says("joint {} has another viscous friction, unlike in its two directions");
  add_term(
      [](const Values& values, int joint) {
        return Term{Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
                      const Eigen::VectorXd speed = at.velocity.col(joint - 1);
                      add_torque(joint,
                                 values[0] * speed.cwiseMax(0) + values[1] * speed.cwiseMin(0),
                                 prediction);
                    }};
      },
      &by_direction);
  return {
      {both_ways, by_direction},
      {},
      {{"", " coefficient forward backward ",
        [](const Subject& of) {
          return change(of.dynamics().viscous, over(of.effort(), 0.1 * of.velocity()));
        },
        "friction does not drive, nor take the drive's largest torque at a tenth of its speed"}}};
}

}  // namespace flexcomp::effects
