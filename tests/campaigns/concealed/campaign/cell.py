"""The nominal robot of a case: a shipped one with a spindle, known friction and rotors."""

import pathlib
import xml.etree.ElementTree as xml

import yaml

SHIPPED = pathlib.Path(__file__).resolve().parents[4] / "host" / "robots"
RATED = {"kr100": 100.0, "kr270": 270.0, "kr360": 360.0, "kr500": 500.0}  # kg


def write_model(rng, folder, gravity):
    """Writes folder/robot.yaml and its URDF; returns the robot's name and its rated load in N."""
    name = str(rng.choice(list(RATED)))
    source = SHIPPED / name
    text = yaml.safe_load((source / "robot.yaml").read_text())
    tree = xml.parse(source / text["urdf"])
    reach = _mount_spindle(rng, tree, text["tool_link"])
    text["gravity"] = [0.0, 0.0, -9.81 if gravity else 0.0]
    text["payload"] = {"mass": round(float(RATED[name] * rng.uniform(0.15, 0.4)), 1),
                       "com": [round(float(rng.uniform(-0.03, 0.03)), 3),
                               round(float(rng.uniform(-0.03, 0.03)), 3),
                               round(float(-reach * rng.uniform(0.3, 0.6)), 3)]}
    effort = {joint.get("name"): float(joint.find("limit").get("effort"))
              for joint in tree.getroot().findall("joint") if joint.get("type") == "revolute"}
    for joint, entry in text["joints"].items():
        entry["coulomb"] = round(effort[joint] * float(rng.uniform(0.005, 0.015)), 2)
        entry["viscous"] = round(effort[joint] * float(rng.uniform(0.005, 0.02)), 2)
        entry["rotor_inertia"] = round(effort[joint] * float(rng.uniform(0.002, 0.005)), 3)
    folder.mkdir(parents=True, exist_ok=True)
    tree.write(folder / text["urdf"])
    (folder / "robot.yaml").write_text(yaml.safe_dump(text, sort_keys=False, allow_unicode=True))
    return name, 9.81 * RATED[name]


def _mount_spindle(rng, tree, tool_link):
    """Moves the tool frame from the flange to the tip of a spindle beside its axis; returns how far
    it stands out of the flange (m)."""
    reach = float(rng.uniform(0.15, 0.35))
    for joint in tree.getroot().findall("joint"):
        if joint.find("child").get("link") == tool_link:
            offset = reach, float(rng.uniform(-0.15, 0.15)), float(rng.uniform(0.05, 0.2))
            joint.find("origin").set("xyz", " ".join(f"{value:.4f}" for value in offset))
    return reach
