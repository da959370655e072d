#include "effects/laws/laws.hpp"

namespace flexcomp::effects {
namespace {

Range tool_shift(const Subject& of) {
  const auto axis = static_cast<Eigen::Index>(of.parameter.back() - 'x');
  return change(of.robot.elastic.tool_compliance[axis],
                softest(kMostShift, kShiftOfReach * of.size.reach, of.size.force));
}

}  // namespace

// Spindle, holder or flange give: a diagonal spring at the tool frame (Klimchik et al. 2017). Its
// rotations do not move the TCP.
Forms laws::tool_compliance() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 3;
  law.traits.is_in_family = true;
  law.parameters = constant({{"x", "m/N"}, {"y", "m/N"}, {"z", "m/N"}});
  law.statement = says("spindle, holder or flange give");
  alter_keys(
      [](const Values& values, int, model::Robot* robot) {
        robot->elastic.tool_compliance.head<3>() +=
            Eigen::Map<const Vector3<double>>(values.data());
      },
      &law);
  return {
      {law},
      {},
      {{"", " x y z ", tool_shift,
        "a tool that gives by a twentieth of the arm's reach under the force it bore is broken"}}};
}

}  // namespace flexcomp::effects
