#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// The foundation or pedestal gives: a diagonal spring at the base frame (contract; Klimchik et al.
// 2017). Needs the TCP, and load.
std::vector<Hypothesis> base_compliance(const Observations& observations) {
  if (!(observations.has(simulation::tcp_position) &&
        (observations.has_wrench() || observations.has_weight()))) {
    return {};
  }
  Hypothesis hypothesis;
  hypothesis.effect = "base_compliance";
  const DiagonalCompliance<double>& known = observations.machine.robot.elastic.base_compliance;
  constexpr const char* kNames[] = {"x", "y", "z", "rx", "ry", "rz"};
  for (Eigen::Index i = 0; i < 6; ++i) {
    hypothesis.parameters.push_back(
        {kNames[i], i < 3 ? "m/N" : "rad/(N·m)", -known[i], 1, i < 3 ? 2e-8 : 5e-8});
  }
  hypothesis.linear = 6;
  hypothesis.alters_model = true;
  hypothesis.statement = "the base gives";
  hypothesis.apply = [](const Values& values, Machine* machine) {
    machine->robot.elastic.base_compliance += Eigen::Map<const Twist<double>>(values.data());
  };
  return {hypothesis};
}

}  // namespace flexcomp::diagnosis
