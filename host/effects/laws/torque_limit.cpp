#include <limits>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// A torque sensor or a drive's current that goes up to a limit, the same in both directions, and
// stays there: the amplifier's or the converter's full scale.
Forms laws::torque_limit() {
  Law law;
  law.joints = every_joint;
  law.traits.is_curved = true;
  law.traits.can_be_undone = false;
  law.parameters = of_joint({{"limit", "N·m"}});
  law.words = "limit of the torque";
  law.statement = says("the torque of joint {} is shown up to a limit, and no further");
  add_term(
      [](const Values& values, int joint) {
        return Term{Term::instrument, [=](const Scene&, const Simulation&, Prediction* prediction) {
                      alter_shown_torque(
                          joint,
                          [&](Eigen::Ref<Eigen::VectorXd> torque) {
                            torque = torque.cwiseMax(-values[0]).cwiseMin(values[0]);
                          },
                          prediction);
                    }};
      },
      &law);
  return {{law},
          {},
          {{"", " limit ",
            [](const Subject&) {
              return Range{0, std::numeric_limits<double>::infinity(), Rest::nowhere};
            },
            "a sensor may be of any range"}}};
}

}  // namespace flexcomp::effects
