#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

// A joint, or every joint, follows its command late, as a first-order lag T x' + x = command
// (Siciliano et al. 2009, section 8), simulated along the command. Needs a command without
// encoders, and motion.
std::vector<Hypothesis> servo_lag(const Observations& observations) {
  std::vector<Hypothesis> all;
  if (!observations.follows_command() || observations.is_static) {
    return all;
  }
  std::vector<Values> guesses;
  for (double constant = 4e-3; constant < 0.6; constant *= 1.5) {
    guesses.push_back({constant});
  }
  // Friction turns with the motion: a lagging joint's torque is far from proportion to its lag.
  const bool jumps = observations.has(simulation::joint_torque);
  for (int joint = 0; joint <= 6; ++joint) {
    Hypothesis hypothesis;
    hypothesis.effect = "servo_lag";
    hypothesis.joint = joint;
    hypothesis.parameters = {{"time_constant", "s", 0, 1, 0.01}};
    hypothesis.linear = jumps ? 0 : 1;
    hypothesis.starts = jumps ? guesses : std::vector<Values>{{}};
    hypothesis.alters_model = true;
    hypothesis.is_curved = true;
    hypothesis.statement = joint == 0 ? "the joints follow their command late"
                                      : fmt::format("joint {} follows its command late", joint);
    hypothesis.apply = [joint](const Values& values, Machine* machine) {
      if (joint == 0) {
        machine->lag.array() += values[0];
      } else {
        machine->lag[joint - 1] += values[0];
      }
    };
    all.push_back(hypothesis);
  }
  return all;
}

}  // namespace flexcomp::diagnosis
