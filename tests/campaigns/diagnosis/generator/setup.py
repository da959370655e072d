"""The robot cell of a case: a shipped robot with a tool, perhaps weight, friction and payload, as files
that flexcomp reads."""

import pathlib
import xml.etree.ElementTree as xml

import numpy as np
import yaml

SHIPPED = pathlib.Path(__file__).resolve().parents[4] / "host" / "robots"
PAYLOADS = {"kr100": 100, "kr270": 270, "kr360": 360, "kr500": 500}  # kg, rated


def write_robot(rng, folder, hints, with_friction):
    """Copies a drawn robot into folder with what the cell adds; returns the path of its YAML, and the
    weight in N that the robot is rated for, to which forces on the tool are drawn."""
    name = str(rng.choice(list(PAYLOADS)))
    source = SHIPPED / name
    text = yaml.safe_load((source / "robot.yaml").read_text())
    tree = xml.parse(source / text["urdf"])
    _mount_tool(rng, tree)
    gravity = hints.get("gravity", False) or rng.random() < hints.get("gravity_share", 0.4)
    text["gravity"] = [0.0, 0.0, -9.81] if gravity else [0.0, 0.0, 0.0]
    if gravity and rng.random() < 0.5:
        text["payload"] = {"mass": round(float(PAYLOADS[name] * rng.uniform(0.1, 0.5)), 1),
                           "com": [round(float(value), 3) for value in
                                   (rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05),
                                    rng.uniform(0.0, 0.2))]}
    if with_friction:
        _add_friction(rng, text, tree)
    tree.write(folder / text["urdf"])
    path = folder / "robot.yaml"
    path.write_text(yaml.safe_dump(text, sort_keys=False, allow_unicode=True))
    return path, 9.81 * PAYLOADS[name]


def _mount_tool(rng, tree):
    """Moves tool0 from the flange to the tip of a spindle that stands off the flange's axis."""
    for joint in tree.getroot().findall("joint"):
        if joint.find("child").get("link") == "tool0":
            side, reach = rng.uniform(0.08, 0.30), rng.uniform(0.10, 0.35)
            angle = rng.uniform(0, 2 * np.pi)
            offset = (reach, side * np.cos(angle), side * np.sin(angle))  # link 6: x out of the flange
            joint.find("origin").set("xyz", " ".join(f"{value:.4f}" for value in offset))


def _add_friction(rng, text, tree):
    effort = {joint.get("name"): float(joint.find("limit").get("effort"))
              for joint in tree.getroot().findall("joint") if joint.get("type") == "revolute"}
    for name, entry in text["joints"].items():
        entry["coulomb"] = round(float(effort[name] * rng.uniform(0.01, 0.03)), 2)
        entry["viscous"] = round(float(effort[name] * rng.uniform(0.01, 0.03)), 2)
        entry["rotor_inertia"] = round(float(effort[name] * rng.uniform(0.001, 0.004)), 3)
