"""Intervals of findings against the truth, where both mean the same one number."""

import math

Z95 = 1.96


def _warmth(truth):
    """Share of friction left on the average of a training recording."""
    warm, duration = truth["warm"], truth["duration"]
    return 1 - truth["warming"] * 0.7 * (1 - warm / duration * (1 - math.exp(-duration / warm)))


def _frames(finding, truth):
    joint, effect = finding.get("joint"), finding["effect"]
    if effect == "joint_stiffness" and joint:
        return {"compliance": truth["compliance"][joint - 1]}
    if effect == "time_offset":
        return {"delay": truth["late"], "offset": truth["late"]}
    if effect == "base_compliance":
        names = ("x", "y", "z", "rx", "ry", "rz")
        return dict(zip(names, truth["base_compliance"]))
    return {}


def _friction(finding, truth):
    """Only where nothing else of the case is in the same number: no gain, no coupling at the joint,
    no friction by load or by low speed."""
    joint, has = finding.get("joint"), truth["has"]
    if not joint or has["gain"] or (has["coupled"] and joint >= 5):
        return {}
    drive, effect = truth["drives"][joint - 1], finding["effect"]
    left = _warmth(truth)
    dry, viscous = drive["dry"], drive["viscous"]
    if effect == "rotor_inertia":
        return {"inertia": drive["rotor"]}
    if has["stribeck"] or drive["by_load"]:
        return {}
    if effect == "coulomb_friction":
        return {"torque": left * sum(dry) / 2, "forward": left * dry[0], "backward": left * dry[1]}
    if effect == "viscous_friction":
        return {"coefficient": left * sum(viscous) / 2, "forward": left * viscous[0],
                "backward": left * viscous[1]}
    return {}


def compared(findings, truth):
    """[{"effect", "joint", "name", "value", "std", "truth", "inside"}, …]."""
    rows = []
    for finding in findings:
        true = (_frames if truth["class"] == "frames" else _friction)(finding, truth)
        for name, size in true.items():
            entry = finding["parameters"].get(name)
            if not isinstance(entry, dict) or not entry.get("std"):
                continue
            value = abs(entry["value"]) if finding["effect"] == "time_offset" else entry["value"]
            rows.append({"effect": finding["effect"], "joint": finding.get("joint"), "name": name,
                         "value": value, "std": entry["std"], "truth": size,
                         "inside": abs(value - size) <= Z95 * entry["std"]})
    return rows
