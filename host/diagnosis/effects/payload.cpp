#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Mass on the flange that differs from the model's, as a point: mass and first moment in the tool
// frame (rigid-body dynamics). Needs gravity in the model or, for torques, motion.
std::vector<Hypothesis> payload(const Observations& observations) {
  if (!(observations.has_weight() || observations.has(simulation::joint_torque))) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "payload";
  hypothesis.parameters = {{"mass", "kg", -500, 1000, 10},
                           {"mx", "kg·m", -300, 300, 1},
                           {"my", "kg·m", -300, 300, 1},
                           {"mz", "kg·m", -300, 300, 1}};
  hypothesis.linear = 4;
  hypothesis.alters_model = true;
  hypothesis.statement = "the mass on the flange is another";
  hypothesis.apply = [](const Values& values, Machine* machine) {
    RobotModel<double, 6>& robot = machine->robot.elastic;
    const Vector3<double> moment = robot.payload_mass * robot.payload_center +
                                   Vector3<double>(values[1], values[2], values[3]);
    robot.payload_mass += values[0];
    robot.payload_center = std::abs(robot.payload_mass) > 1e-3
                               ? Vector3<double>(moment / robot.payload_mass)
                               : Vector3<double>::Zero();
  };
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
