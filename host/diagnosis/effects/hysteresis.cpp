#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

namespace {

/// In −1…1, of torques and a yield torque, both in N·m.
using Loop = Eigen::VectorXd (*)(const Eigen::VectorXd&, double);

/// The joint came to the first torque from none.
template <Loop loop>
Eigen::VectorXd from_zero(const Eigen::VectorXd& torque, double yield) {
  Eigen::VectorXd since(torque.size() + 1);
  since << 0, torque;
  return loop(since, yield).tail(torque.size());
}

constexpr std::pair<const char*, Loop> kForms[] = {
    {"bouc_wen", simulation::bouc_wen},
    {"prandtl_ishlinskii", simulation::prandtl_ishlinskii},
    {"bouc_wen_from_zero", from_zero<simulation::bouc_wen>},
    {"prandtl_ishlinskii_from_zero", from_zero<simulation::prandtl_ishlinskii>}};

}  // namespace

// A rate-independent loop of torque and wind-up beside the spring, as Bouc and Wen's or as
// Prandtl and Ishlinskii's (Wen 1976; Visintin 1994), simulated along the load: dry friction in
// parallel to the spring lets the wind-up lag behind its straight line by up to `amplitude`
// either way, so that the loop takes energy; `yield_torque` is the rise of the load by which it
// does so late, whichever the form: the integral of 1 − lag / amplitude over a load that rises
// from none. What went before a recording is not known: the loop begins relaxed at its first
// torque, or as that torque left it coming from zero. Needs the TCP or link encoders, and a load
// that rises and falls.
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
    for (const auto& [form, loop] : kForms) {
      hypothesis.form = form;
      hypothesis.apply = [joint, loop = loop](const Values& values, Machine* machine) {
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
