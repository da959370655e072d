#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// The floor slopes: the TCP stands higher by a part of joint 1's angle.
Forms laws::sloping_floor() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 1;
  law.parameters = constant({{"slope", "m/rad"}});
  law.statement = says("the floor slopes");
  add_term(
      [](const Values& values, int) {
        return Term{Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
                      if (prediction->channel[simulation::tcp_position].cols() > 0) {
                        prediction->channel[simulation::tcp_position].col(2) +=
                            values[0] * at.q.col(0);
                      }
                    }};
      },
      &law);
  return {{law},
          {},
          {{"", " slope ", [](const Subject&) { return within(0.1); },
            "no floor slopes by more than a tenth of a metre a radian"}}};
}

}  // namespace flexcomp::effects
