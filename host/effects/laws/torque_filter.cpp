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
  law.statement = [](int joint) -> std::string {
    return joint == 0 ? "the torques are shown behind a low-pass"
                      : fmt::format("the torque of joint {} is shown behind a low-pass", joint);
  };
  add_term(
      [](const Values& values, int which) {
        return Term{
            Term::instrument, [=](const Scene& scene, const Simulation&, Prediction* prediction) {
              Eigen::MatrixXd& torque = prediction->channel[simulation::joint_torque];
              if (scene.is_static) {
                return;
              }
              for (Eigen::Index column = 0; column < torque.cols(); ++column) {
                if (which == 0 || which == column + 1) {
                  torque.col(column) = simulation::lag(scene.time, torque.col(column), values[0]);
                }
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
