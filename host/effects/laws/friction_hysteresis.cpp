#include <algorithm>
#include <cmath>

#include "effects/laws/laws.hpp"
#include "simulation/history.hpp"

namespace flexcomp::effects {
namespace {

/// Share of the friction that acts, in −1…1, along a motion: after a reversal first the gap is
/// crossed without any, then the contact winds up over the slip, then it slides.
Eigen::VectorXd gripped(const Eigen::VectorXd& motion, double gap, double slip) {
  const Eigen::VectorXd strain =
      motion - simulation::play(motion, 0.5 * gap + slip);  // within ± (gap/2 + slip)
  return strain.unaryExpr([=](double z) {
    const double wound = std::clamp((std::abs(z) - 0.5 * gap) / slip, 0.0, 1.0);
    return z < 0 ? -wound : wound;
  });
}

using Grip = Eigen::VectorXd (*)(const Eigen::VectorXd&, const Values&);

Eigen::VectorXd with_play(const Eigen::VectorXd& motion, const Values& values) {
  return gripped(motion, values[2], values[1]);
}

Eigen::VectorXd without_play(const Eigen::VectorXd& motion, const Values& values) {
  return gripped(motion, 0, values[1]);
}

Eigen::VectorXd by_dahl(const Eigen::VectorXd& motion, const Values& values) {
  return simulation::bouc_wen(motion, values[1]);
}

Law grip_law(const char* form, Grip grip, std::vector<Parameter> parameters) {
  Law law;
  law.form = form;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.traits.is_friction = true;
  law.traits.joins_family = grip == by_dahl;  // one form of them, smooth in both parameters
  law.parameters = of_joint(std::move(parameters));
  law.words = "dry friction that builds up";
  law.statement = says("friction of joint {} builds up in a loop after every reversal");
  add_term(
      [grip](const Values& values, int joint) {
        return Term{Term::output, [=](const Scene&, const Simulation& at, Prediction* prediction) {
                      add_torque(joint, values[0] * grip(at.q.col(joint - 1), values), prediction);
                    }};
      },
      &law);
  return law;
}

}  // namespace

// Dry friction whose torque follows the motion in a loop: after a reversal it has to be built up
// over a slip, with or without play first. Forms: elastic slider with play (Iwan 1966, in series
// with a gap), elastic slider (Prandtl 1928), and Dahl's (1968), which is Bouc and Wen's along the
// motion.
Forms laws::friction_hysteresis() {
  const Parameter torque{"torque", "N·m"};
  const Parameter slip{"slip", "rad"};
  return {
      {grip_law("play", with_play, {torque, slip, {"gap", "rad"}}),
       grip_law("slider", without_play, {torque, slip}), grip_law("dahl", by_dahl, {torque, slip})},
      {},
      {{"", " torque ", [](const Subject& of) { return up_to(of.effort()); },
        "friction does not drive, and a joint moves that its drive can move"},
       {"", " slip ", [](const Subject&) { return up_to(0.1); },
        "friction of contacts and belts is built up within some degrees of turning back (Al-Bender "
        "and Swevers 2008); built up at once it is dry friction"},
       {"", " gap ", [](const Subject&) { return up_to(0.1); },
        "brakes, belts and seals grip within some degrees of turning back; no gear's teeth are "
        "meant"}}};
}

}  // namespace flexcomp::effects
