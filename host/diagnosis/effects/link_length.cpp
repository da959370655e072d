#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// Length of the link that a joint moves, along the line to the next joint (kinematic calibration;
// Mooring, Roth and Driels 1991). Needs the TCP.
std::vector<Hypothesis> link_length(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!observations.has(simulation::tcp_position)) {
    return all;
  }
  for (int joint = 1; joint <= 5; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "link_length";
    hypothesis.joint = joint;
    const Vector3<double> along =
        observations.machine.robot.elastic.joints[static_cast<std::size_t>(joint)].origin.position;
    if (along.norm() < 1e-6) {
      continue;
    }
    hypothesis.parameters = {{"length", "m", -0.1, 0.1, 1e-4}};
    hypothesis.linear = 1;
    hypothesis.alters_model = true;
    hypothesis.statement = fmt::format("the link that joint {} moves has another length", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      Vector3<double>& next =
          machine->robot.elastic.joints[static_cast<std::size_t>(joint)].origin.position;
      next += values[0] * next.normalized();
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
