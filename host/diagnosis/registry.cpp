#include "diagnosis/effects/effects.hpp"

namespace flexcomp::diagnosis {

const std::vector<Effect>& registry() {
  static const std::vector<Effect> kEffects = {
      backlash,      base_compliance, coulomb_friction,    gravity_compensator,
      hysteresis,    joint_offset,    joint_stiffness,     link_flexibility,
      link_length,   link_mass,       nonlinear_stiffness, payload,
      resonance,     rotor_inertia,   servo_lag,           stribeck_friction,
      tcp_offset,    thermal_drift,   time_offset,         tool_compliance,
      torque_offset, torque_ripple,   transmission_ripple, viscous_friction,
      wrench_bias,   wrench_frame,    wrench_scale,
  };
  return kEffects;
}

std::vector<Hypothesis> all_hypotheses(const Observations& observations) {
  std::vector<Hypothesis> all;
  for (const Effect effect : registry()) {
    for (Hypothesis& hypothesis : effect(observations)) {
      if (!hypothesis.starts.empty()) {
        all.push_back(std::move(hypothesis));
      }
    }
  }
  return all;
}

}  // namespace flexcomp::diagnosis
