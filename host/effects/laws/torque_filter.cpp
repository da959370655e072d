#include "effects/laws/laws.hpp"
#include "simulation/history.hpp"

namespace flexcomp::effects {

// The torque of a joint, or of every joint, is shown behind a low-pass of the first order,
// T y' + y = torque: the filter of a drive's current or of a torque sensor. A delay keeps what is
// quick and shows it late; a low-pass shows less of it.
Forms laws::torque_filter() {
  Law law;
  law.joints = machine_or_joint;
  law.traits.is_curved = true;
  law.traits.can_be_undone = false;
  law.parameters = constant({{"time_constant", "s"}});
  law.words = "low-pass of the torque";
  law.statement = says("the torques are shown behind a low-pass",
                       "the torque of joint {} is shown behind a low-pass");
  add_term(
      [](const Values& values, int joint) {
        return Term{Term::instrument,
                    [=](const Scene& scene, const Simulation&, Prediction* prediction) {
                      if (!scene.is_static) {
                        alter_shown_torque(
                            joint,
                            [&](Eigen::Ref<Eigen::VectorXd> torque) {
                              torque = simulation::lag(scene.time, torque, values[0]);
                            },
                            prediction);
                      }
                    }};
      },
      &law);
  return {{law},
          {},
          {{"", " time_constant ", [](const Subject&) { return up_to(1); },
            "drives show their currents filtered at 1 Hz or above"}}};
}

}  // namespace flexcomp::effects
