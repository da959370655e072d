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

struct Form {
  const char* name;
  Loop loop;
  double reach;  ///< of the yield torques tried, over the joint's load
};

/// Elements that slide one after another reach to twice the load, with that still half of them
/// stick; if they reached farther the loop would pass for a softer spring.
constexpr Form kForms[] = {
    {"bouc_wen", simulation::bouc_wen, 1},
    {"prandtl_ishlinskii", simulation::prandtl_ishlinskii, 0.5},
    {"bouc_wen_from_zero", from_zero<simulation::bouc_wen>, 1},
    {"prandtl_ishlinskii_from_zero", from_zero<simulation::prandtl_ishlinskii>, 0.5}};

/// Wind-up less by what friction beside the spring holds.
void apply_loop(int joint, Loop loop, const Values& values, Machine* machine) {
  machine->terms.push_back(
      {simulation::Term::load, [=](const Scene&, const Simulation& at, Prediction* prediction) {
         add_load_driven(
             at, joint,
             [&](const Eigen::VectorXd& torque) {
               return Eigen::VectorXd(-values[0] * loop(torque, values[1]));
             },
             prediction);
       }});
}

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
    hypothesis.linear = 1;
    hypothesis.statement = fmt::format("joint {} has a loop in its torque-deflection curve", joint);
    for (const Form& form : kForms) {
      const double scale = form.reach * load;
      hypothesis.form = form.name;
      hypothesis.parameters = {{"amplitude", "rad", 0, 0.05, 1e-4},
                               {"yield_torque", "N·m", 0.01 * scale, scale, 0.02 * scale}};
      hypothesis.starts.clear();
      for (const double share : {0.05, 0.1, 0.18, 0.3, 0.5, 0.9}) {
        hypothesis.starts.push_back({share * scale});
      }
      hypothesis.apply = [joint, loop = form.loop](const Values& values, Machine* machine) {
        apply_loop(joint, loop, values, machine);
      };
      all.push_back(hypothesis);
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
