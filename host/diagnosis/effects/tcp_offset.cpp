#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// The tool tip is not where the model has it, by a vector in the tool frame. Needs the TCP, and
// rotations of the tool.
std::vector<Hypothesis> tcp_offset(const Observations& observations) {
  if (!observations.has(simulation::tcp_position)) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "tcp_offset";
  hypothesis.parameters = {
      {"x", "m", -10, 10, 1e-4}, {"y", "m", -10, 10, 1e-4}, {"z", "m", -10, 10, 1e-4}};
  hypothesis.linear = 3;
  hypothesis.alters_model = true;
  hypothesis.statement = "the tool tip is elsewhere";
  hypothesis.apply = [](const Values& values, Machine* machine) {
    Pose<double>& tool = machine->robot.elastic.tool;
    tool.position += tool.rotation * Vector3<double>(values[0], values[1], values[2]);
  };
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
