"""Findings that cannot be, and names of what is not there.

Limits are wide: beyond them no machine of the kind is, whatever was concealed. Where the truth has a
number of its own, a finding of the opposite sign, or of many times its size, cannot be either.
"""

import yaml

MANY = 4.0  # times the concealed size
ADDED = 8.0  # the same of a frame, one standard deviation: several frames may show in one number

# effect -> parameter -> largest size of a change that can be (SI)
LIMITS = {
    "joint_offset": {"offset": 0.05},
    "joint_axis": {"tilt_x": 0.05, "tilt_y": 0.05, "tilt_z": 0.05},
    "link_length": {"length": 0.02},
    "link_offset": {"x": 0.02, "y": 0.02, "z": 0.02},
    "tcp_offset": {"x": 0.1, "y": 0.1, "z": 0.1},
    "gravity_tilt": {"rx": 0.05, "ry": 0.05},
    "base_frame": {"x": 3.0, "y": 3.0, "z": 3.0, "rx": 0.8, "ry": 0.8, "rz": 0.8},
    "backlash": {"gap": 0.01},
    "time_offset": {"delay": 0.1, "offset": 0.1},
    "servo_lag": {"time_constant": 0.2, "lag": 0.2},
    "thermal_drift": {"x": 1e-3, "y": 1e-3, "z": 1e-3},
    "transmission_ripple": {"amplitude": 2e-3, "sine": 2e-3, "cosine": 2e-3},
}
# Numbers of a joint in robot.yaml that are nothing or more.
NOT_NEGATIVE = "compliance", "viscous", "coulomb", "rotor_inertia", "backlash"

GEOMETRY = {"joint_offset", "joint_axis", "link_length", "tcp_offset", "base_frame", "link_frame",
            "link_offset"}
ALWAYS = {"law"}  # says itself what it is
PRESENT = {
    "frames": GEOMETRY | {"joint_stiffness", "transmission_ripple", "thermal_drift"},
    "friction": {"coulomb_friction", "viscous_friction", "friction_hysteresis", "rotor_inertia",
                 "torque_offset", "link_mass", "link_inertia", "torque_ripple"},
}


def present(truth):
    """Names of what is concealed in a case."""
    names = ALWAYS | PRESENT[truth["class"]]
    if truth["class"] == "frames":
        # The first frame is off against the vertical too, so that weight bends the arm otherwise.
        names |= {"gravity_tilt"}
        names |= {"time_offset"} if truth["late"] else set()
        names |= {"base_compliance"} if truth["has_base_compliance"] else set()
        return names
    has = truth["has"]
    # A last link of another mass is a payload too.
    names |= {"payload"}
    names |= {"stribeck_friction"} if has["stribeck"] else set()
    names |= {"load_friction", "friction_load"} if has["load"] else set()
    names |= {"torque_gain"} if has["gain"] else set()
    names |= {"transmission"} if has["coupled"] else set()
    return names


def wrong_names(findings, truth):
    """["effect joint", …] of findings of what is not there."""
    there = present(truth)
    return [f"{each['effect']} {each.get('joint') or ''}".strip() for each in findings
            if each["effect"] not in there]


def _values(finding):
    return {name: entry["value"] for name, entry in finding["parameters"].items()
            if isinstance(entry, dict) and isinstance(entry.get("value"), (int, float))}


def _beyond_limits(finding):
    limits = LIMITS.get(finding["effect"], {})
    return [f"{finding['effect']} {finding.get('joint') or ''} {name} {value:.3g}"
            for name, value in _values(finding).items()
            if name in limits and abs(value) > limits[name]]


def _off_frames(finding, truth):
    """Lengths and angles that many concealed ones together do not make, as where two large ones that a
    recording cannot tell apart cancel."""
    length, angle = (max(least, ADDED * truth[name])
                     for name, least in (("length", 2e-3), ("angle", 4e-3)))
    sizes = {"link_length": length, "link_offset": length, "joint_axis": angle,
             "joint_offset": angle}
    size = sizes.get(finding["effect"])
    return [f"{finding['effect']} {finding.get('joint') or ''} {name} {value:.3g}"
            for name, value in _values(finding).items() if size and abs(value) > size]


def _against_truth(finding, truth):
    """Friction, rotors and masses of a sign or a size that cannot be."""
    if truth["class"] != "friction":
        return _off_frames(finding, truth)
    joint, effect, values = finding.get("joint"), finding["effect"], _values(finding)
    place = f"{effect} {joint or ''}".strip()
    if effect == "payload" and values.get("mass", 0.0) < 0:
        # The nominal models carry nothing; a last link that is lighter may look so.
        return [f"{place} mass {values['mass']:.3g}"]
    if not joint:
        return []
    if effect == "link_mass" and len(truth["masses"]) >= joint:
        nominal = truth["masses"][joint - 1][0]
        change = values.get("mass", 0.0)
        heaviest = MANY * (nominal + truth["payload"]["mass"])
        if change < -0.9 * nominal or change > heaviest:
            return [f"{place} mass {change:.3g} of {nominal:.3g}"]
    drive = truth["drives"][joint - 1]
    sizes = {"coulomb_friction": (max(drive["dry"]) * (1 + drive["stick"] + drive["by_load"]),
                                  ("torque", "coulomb")),
             "viscous_friction": (max(drive["viscous"]) + max(drive["dry"]) / 0.1,
                                  ("coefficient", "viscous")),
             "rotor_inertia": (drive["rotor"] * 2 + _inertia(truth, joint),
                               ("inertia", "rotor_inertia"))}
    if effect not in sizes:
        return []
    size, names = sizes[effect]
    return [f"{place} {name} {values[name]:.3g}, truly {size:.3g} at most" for name in names
            if name in values and not 0 <= values[name] <= MANY * size]


def _inertia(truth, joint):
    """What links beyond a joint may add to its rotor's inertia (kg·m²), roughly."""
    return 0.25 * sum(after for _, after in truth["masses"][joint - 1:])


def _negative_numbers(model):
    joints = (model or {}).get("joints", {})
    # PyYAML takes 1e-6 for a word.
    found = [f"{joint} {key} {entry[key]}" for joint, entry in joints.items()
             for key in NOT_NEGATIVE if float(entry.get(key, 0.0)) < 0]
    mass = float(((model or {}).get("payload") or {}).get("mass", 0.0))
    return found + ([f"payload {mass:.3g} kg"] if mass < 0 else [])


def impossible(findings, model_text, truth):
    """[words, …] of findings, and numbers of the updated model, that cannot be."""
    found = _negative_numbers(yaml.safe_load(model_text))
    for finding in findings:
        found += _beyond_limits(finding) + _against_truth(finding, truth)
    return found
