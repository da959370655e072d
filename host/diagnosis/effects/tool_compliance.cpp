#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Spindle, holder or flange give: a diagonal spring at the tool frame (contract). Its rotations do
// not move the TCP. Needs the TCP, and a wrench.
std::vector<Hypothesis> tool_compliance(const Observations& observations) {
  if (!(observations.has(simulation::tcp_position) && observations.has_wrench())) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "tool_compliance";
  const DiagonalCompliance<double>& known = observations.machine.robot.elastic.tool_compliance;
  constexpr const char* kNames[] = {"x", "y", "z"};
  for (Eigen::Index i = 0; i < 3; ++i) {
    hypothesis.parameters.push_back({kNames[i], "m/N", -known[i], 1, 1e-7});
  }
  hypothesis.linear = 3;
  hypothesis.alters_model = true;
  hypothesis.statement = "spindle, holder or flange give";
  hypothesis.apply = [](const Values& values, Machine* machine) {
    machine->robot.elastic.tool_compliance.head<3>() +=
        Eigen::Map<const Vector3<double>>(values.data());
  };
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
