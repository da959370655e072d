"""Fitted parameters against the true ones, where both mean the same number.

The contract fixes the units of parameters, not their names: a parameter is compared if it goes by one
of the names below. Signs that depend on a convention are left out of the comparison.
"""

Z95 = 1.96

# effect -> true parameter -> names that a finding may give it
NAMES = {
    "backlash": {"gap": ("gap",)},
    "joint_stiffness": {"compliance": ("compliance",), "compliance_change": ("compliance_change",)},
    "nonlinear_stiffness": {"cubic_compliance": ("cubic_compliance",)},
    "base_compliance": {name: (name, f"translation_{name}") for name in "xyz"}
    | {f"r{name}": (f"r{name}", f"rotation_{name}") for name in "xyz"},
    "tool_compliance": {name: (name, f"translation_{name}") for name in "xyz"},
    "joint_offset": {"offset": ("offset",)},
    "link_length": {"length": ("length", "length_change")},
    "tcp_offset": {name: (name, f"offset_{name}") for name in "xyz"},
    "transmission_ripple": {"amplitude": ("amplitude",), "order": ("order",)},
    "torque_ripple": {"amplitude": ("amplitude",), "order": ("order",)},
    "servo_lag": {"time_constant": ("time_constant", "lag")},
    "resonance": {"frequency": ("frequency",), "damping": ("damping", "damping_ratio")},
    "time_offset": {"delay": ("delay", "offset")},
    "coulomb_friction": {"torque": ("torque", "coulomb_change", "coulomb")},
    "viscous_friction": {"coefficient": ("coefficient", "viscous_change", "viscous")},
    "stribeck_friction": {"excess": ("excess", "amplitude"), "speed": ("speed", "stribeck_speed")},
    "rotor_inertia": {"inertia": ("inertia", "inertia_change", "rotor_inertia")},
    "torque_offset": {"torque": ("torque", "offset")},
    "payload": {"mass": ("mass", "mass_change")},
    "thermal_drift": {},
    "hysteresis": {"amplitude": ("amplitude",), "yield_torque": ("yield_torque",)},
}
UNSIGNED = ("joint_offset", "time_offset", "torque_offset", "tcp_offset", "link_length")


def coverage(effect, fitted):
    """How many fitted parameters have the truth in their 95 % interval, of how many compared."""
    covered = compared = 0
    for name, names in NAMES.get(effect["effect"], {}).items():
        entry = next((fitted[other] for other in names if other in fitted), None)
        if name not in effect["parameters"] or entry is None or not entry["std"]:
            continue
        value, truth = entry["value"], effect["parameters"][name]
        if effect["effect"] in UNSIGNED:
            value, truth = abs(value), abs(truth)
        compared += 1
        covered += abs(value - truth) <= Z95 * entry["std"]
    return covered, compared
