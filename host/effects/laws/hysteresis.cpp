#include "effects/laws/laws.hpp"
#include "simulation/history.hpp"

namespace flexcomp::effects {
namespace {

/// A loop, in −1…1, along torques (N·m) and with a yield torque (N·m).
using Loop = Eigen::VectorXd (*)(const Eigen::VectorXd&, double);

/// The loop of a joint that came to the first torque from none.
template <Loop loop>
Eigen::VectorXd from_zero(const Eigen::VectorXd& torque, double yield) {
  Eigen::VectorXd since(torque.size() + 1);
  since << 0, torque;
  return loop(since, yield).tail(torque.size());
}

/// Wind-up less by what friction beside the spring holds.
Term loop_term(int joint, Loop loop, const Values& values) {
  return {Term::load, [=](const Scene&, const Simulation& at, Prediction* prediction) {
            add_load_driven(
                at, joint,
                [&](const Eigen::VectorXd& torque) {
                  return Eigen::VectorXd(-values[0] * loop(torque, values[1]));
                },
                prediction);
          }};
}

Law loop_law(const char* form, Loop loop) {
  Law law;
  law.form = form;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.parameters = of_joint({{"amplitude", "rad"}, {"yield_torque", "N·m"}});
  law.statement = says("joint {} has a loop in its torque-deflection curve");
  add_term([loop](const Values& values, int joint) { return loop_term(joint, loop, values); },
           &law);
  return law;
}

}  // namespace

// A rate-independent loop of torque and wind-up beside the spring, as Bouc and Wen's or as
// Prandtl and Ishlinskii's (Wen 1976; Visintin 1994): dry friction in parallel to the spring lets
// the wind-up lag behind its straight line by up to `amplitude` either way, so that the loop takes
// energy. `yield_torque` is the rise of the load by which it does so late, whichever the form: the
// integral of 1 − lag / amplitude over a load that rises from none. The history before a recording
// is not known: the loop begins relaxed at its first torque, or as that torque left it coming from
// zero.
Forms laws::hysteresis() {
  return {{loop_law("bouc_wen", simulation::bouc_wen),
           loop_law("prandtl_ishlinskii", simulation::prandtl_ishlinskii),
           loop_law("bouc_wen_from_zero", from_zero<simulation::bouc_wen>),
           loop_law("prandtl_ishlinskii_from_zero", from_zero<simulation::prandtl_ishlinskii>)},
          {},
          {{"", " amplitude ", [](const Subject&) { return up_to(0.01); },
            "as the gap of backlash: gears' data sheets give both as lost motion"},
           {"", " yield_torque ",
            [](const Subject& of) {
              return Range{0, of.effort()};
            },
            "friction beyond the drive's largest torque would hold the joint"}}};
}

}  // namespace flexcomp::effects
