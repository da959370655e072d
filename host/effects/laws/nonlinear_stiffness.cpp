#include <algorithm>

#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

/// Wind-up c1 τ + c3 τ³ that turns back no more than the cubic of a spring that levels off, nor is
/// beyond tenfold, under the largest load. The cubic that comes nearest to tanh over ±2 loses half
/// of the straight line's wind-up at the end.
Range cubic_spring(const Subject& of) {
  const double load = std::max(of.load(), 1.0);
  const double straight = of.joint().compliance / (load * load);
  const double known = of.joint().cubic_compliance;
  return {-straight / 2 - known, std::min(10 * straight, kMostTurn) - known};
}

}  // namespace

// Cubic torque-deflection curve of a joint, deflection = c1 tau + c3 tau^3, softening above zero
// and hardening below (strain-wave and cycloidal gears; Albu-Schaeffer 2002).
Forms laws::nonlinear_stiffness() {
  Law law;
  law.joints = every_joint;
  law.traits.linear_in = 1;
  law.parameters = of_joint({{"cubic_compliance", "rad/(N·m)^3"}});
  law.words = "stiffness that changes with load";
  law.statement = says("joint {} winds up out of proportion to its torque");
  alter_keys(
      [](const Values& values, int joint, model::Robot* robot) {
        robot->elastic.joints[index_of(joint)].cubic_compliance += values[0];
      },
      &law);
  return {
      {law},
      {},
      {{"", " cubic_compliance ", cubic_spring,
        "more torque winds up more; the cubic of a spring that levels off turns back a little"}}};
}

}  // namespace flexcomp::effects
