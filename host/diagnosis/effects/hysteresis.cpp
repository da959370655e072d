#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// A rate-independent loop of torque and wind-up beside the spring, as Bouc and Wen's or as Prandtl
// and Ishlinskii's (Wen 1976; Visintin 1994), simulated along the load: dry friction in parallel to
// the spring lets the wind-up lag behind its straight line by up to `amplitude` either way, so that
// the loop takes energy. Needs the TCP or link encoders, and a load that rises and falls.
std::vector<Hypothesis> hysteresis(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!sees_angles(observations)) {
    return all;
  }
  for (int joint = 1; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "hysteresis";
    hypothesis.joint = joint;
    const double load = observations.largest_load(joint);
    if (load < 0.01) {
      continue;
    }
    hypothesis.parameters = {{"amplitude", "rad", 0, 0.05, 1e-4},
                             {"yield_torque", "N·m", 0.01 * load, load, 0.02 * load}};
    hypothesis.linear = 1;
    hypothesis.starts.clear();
    for (const double share : {0.05, 0.1, 0.18, 0.3, 0.5, 0.9}) {
      hypothesis.starts.push_back({share * load});
    }
    hypothesis.statement = fmt::format("joint {} has a loop in its torque-deflection curve", joint);
    for (const auto loop : {simulation::bouc_wen, simulation::prandtl_ishlinskii}) {
      hypothesis.form = loop == simulation::bouc_wen ? "bouc_wen" : "prandtl_ishlinskii";
      hypothesis.apply = [joint, loop](const Values& values, Machine* machine) {
        machine->terms.push_back({simulation::Term::load,
                                  [=](const Scene&, const Simulation& at, Prediction* prediction) {
                                    add_load_driven(
                                        at, joint,
                                        [&](const Eigen::VectorXd& torque) {
                                          return Eigen::VectorXd(-values[0] *
                                                                 loop(torque, values[1]));
                                        },
                                        prediction);
                                  }});
      };
      all.push_back(hypothesis);
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
