#include "effects/laws/laws.hpp"

namespace flexcomp::effects {

// The tool tip is not where the model has it, by a vector in the tool frame (kinematic calibration;
// Mooring, Roth and Driels 1991).
Forms laws::tcp_offset() {
  Law law;
  law.joints = whole_machine;
  law.traits.linear_in = 3;
  law.traits.is_in_family = true;
  law.traits.registers = Registers::point;
  law.parameters = constant({{"x", "m"}, {"y", "m"}, {"z", "m"}});
  law.words = "place of the tool's tip";
  law.statement = says("the tool tip is elsewhere");
  alter_robot(
      [](const Values& values, int, model::Robot* robot) {
        Pose<double>& tool = robot->elastic.tool;
        tool.position += tool.rotation * Vector3<double>(values[0], values[1], values[2]);
      },
      &law);
  return {{law},
          {},
          {{"", " x y z ", [](const Subject& of) { return within(0.5 * of.size.reach); },
            "no tool is longer than half of the arm's reach"}}};
}

}  // namespace flexcomp::effects
