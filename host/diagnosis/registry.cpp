#include "diagnosis/effects/effects.hpp"
#include "diagnosis/plausible.hpp"

namespace flexcomp::diagnosis {

const std::vector<Effect>& registry() {
  static const std::vector<Effect> kEffects = {
      {"backlash", backlash, {"load", "motion"}},
      {"base_compliance", base_compliance, {}},
      {"base_frame", base_frame, {}},
      {"coulomb_friction", coulomb_friction, {}},
      {"friction_hysteresis", friction_hysteresis, {"play", "slider", "dahl"}},
      {"gravity_compensator", gravity_compensator, {"", "sine"}},
      {"hysteresis",
       hysteresis,
       {"bouc_wen", "prandtl_ishlinskii", "bouc_wen_from_zero", "prandtl_ishlinskii_from_zero"}},
      {"joint_axis", joint_axis, {}},
      {"joint_offset", joint_offset, {}},
      {"joint_stiffness", joint_stiffness, {}},
      {"link_flexibility", link_flexibility, {"springs", "beam"}},
      {"link_length", link_length, {}},
      {"link_mass", link_mass, {"body", "mounted"}},
      {"nonlinear_stiffness", nonlinear_stiffness, {}},
      {"payload", payload, {}},
      {"resonance", resonance, {"", "posture"}},
      {"rotor_inertia", rotor_inertia, {}},
      {"servo_lag", servo_lag, {}},
      {"stribeck_friction", stribeck_friction, {}},
      {"tcp_offset", tcp_offset, {}},
      {"thermal_drift", thermal_drift, {"temperature", "time"}},
      {"time_offset", time_offset, {"tcp_position", "joint_torque", "joint_deflection", "wrench"}},
      {"tool_compliance", tool_compliance, {}},
      {"torque_offset", torque_offset, {}},
      {"torque_ripple", torque_ripple, {}},
      {"transmission_ripple", transmission_ripple, {}},
      {"viscous_friction", viscous_friction, {"", "by_direction"}},
      {"wrench_bias", wrench_bias, {}},
      {"wrench_frame", wrench_frame, {}},
      {"wrench_scale", wrench_scale, {}},
  };
  return kEffects;
}

bool are_the_same(const Hypothesis& a, const Hypothesis& b) {
  return a.effect == b.effect && a.joint == b.joint;
}

std::vector<Hypothesis> all_hypotheses(const Observations& observations) {
  std::vector<Hypothesis> all;
  const MachineSize size = size_of(observations);
  for (const Effect& effect : registry()) {
    for (Hypothesis& hypothesis : effect.hypotheses(observations)) {
      keep_plausible(observations.machine.robot, size, &hypothesis);
      all.push_back(std::move(hypothesis));
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
