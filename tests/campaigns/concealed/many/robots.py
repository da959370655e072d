"""Nominal robots: those that come with flexcomp, and others from public packages.

A URDF is cut down to the six joints from base to tip, given a tool, and written anew beside a
robot.yaml.
"""

import dataclasses
import importlib.util
import pathlib
import sys
import xml.etree.ElementTree as xml

import numpy as np
import yaml

SHIPPED = pathlib.Path(__file__).resolve().parents[4] / "host" / "robots"


class Missing(Exception):
    """A package of robots is not installed."""


@dataclasses.dataclass(frozen=True)
class Source:
    """Where a robot comes from, and what its URDF does not say."""

    urdf: object  # () -> path
    base: str
    tip: str
    compliance: tuple  # (6,) rad/(N·m)
    rated: float  # kg
    effort: tuple = ()  # (6,) N·m, where the URDF has none
    speed: tuple = ()  # (6,) rad/s, the same


def _shipped(name):
    return lambda: SHIPPED / name / f"{name}.urdf"


def _rtb(path):
    def find():
        found = importlib.util.find_spec("rtbdata")
        if found is None:
            raise Missing("rtb-data")
        return pathlib.Path(found.submodule_search_locations[0]) / path
    return find


def _example(path):
    """From example-robot-data, which installs beside its module rather than in it."""
    def find():
        for folder in map(pathlib.Path, sys.path):
            found = folder / "cmeel.prefix/share/example-robot-data/robots" / path
            if found.exists():
                return found
        raise Missing("example-robot-data")
    return find


def _kuka(name, rated):
    joints = yaml.safe_load((SHIPPED / name / "robot.yaml").read_text())["joints"]
    return Source(_shipped(name), "base_link", "tool0",
                  tuple(float(entry["compliance"]) for entry in joints.values()), rated)


SOURCES = {
    "kr100": _kuka("kr100", 100.0),
    "kr270": _kuka("kr270", 270.0),
    "kr360": _kuka("kr360", 360.0),
    "kr500": _kuka("kr500", 500.0),
    # ROS-Industrial's; torques as of the KR 270, springs a little softer.
    "kr210": Source(_rtb("xacro/kuka_description/kuka_kr210/urdf/kr210l150.urdf"), "base_link",
                    "tool0", (0.6e-6, 0.35e-6, 0.5e-6, 3e-6, 3.6e-6, 2.5e-6), 150.0,
                    (20000, 25000, 16000, 3500, 3500, 1800)),
    # Springs of strain wave gears of their size.
    "ur10": Source(_example("ur_description/urdf/ur10_robot.urdf"), "base_link", "tool0",
                   (1.5e-5, 1.5e-5, 2.5e-5, 1e-4, 1e-4, 1e-4), 10.0),
    "ur5": Source(_example("ur_description/urdf/ur5_robot.urdf"), "base_link", "tool0",
                  (3e-5, 3e-5, 4e-5, 1.5e-4, 1.5e-4, 1.5e-4), 5.0),
    "z1": Source(_example("z1_description/urdf/z1.urdf"), "link00", "gripperStator",
                 (2e-4, 1.5e-4, 2e-4, 4e-4, 4e-4, 4e-4), 2.0),
}
FOREIGN = ("kr210", "ur10", "ur5", "z1")


def available():
    """Names of the robots whose packages are here."""
    found = []
    for name, source in SOURCES.items():
        try:
            source.urdf()
        except Missing:
            continue
        found.append(name)
    return found


def _chain(root, base, tip):
    by_child = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
    chain, link = [], tip
    while link != base:
        chain.insert(0, by_child[link])
        link = chain[0].find("parent").get("link")
    return chain


def _kept(element, names):
    """A copy with some of its children."""
    copy = xml.Element(element.tag, {key: element.attrib[key] for key in ("name", "type")
                                     if key in element.attrib})
    for name in names:
        found = element.find(name)
        if found is not None:
            copy.append(found)
    return copy


def _link(root, name):
    link = next(each for each in root.findall("link") if each.get("name") == name)
    mass = link.find("inertial/mass")
    has_mass = mass is not None and float(mass.get("value")) > 0
    return _kept(link, ("inertial",) if has_mass else ())


def _complete(joint, number, source):
    limit = joint.find("limit")
    for key, values in (("effort", source.effort), ("velocity", source.speed)):
        if values:
            limit.set(key, str(float(values[number])))


def write_model(name, folder, tool, *, gravity=True, compliance=None, joints=None, payload=None):
    """Writes folder/robot.urdf and robot.yaml.

    tool: (3,) m, where the TCP stands in the robot's own tool frame. compliance: (6,) in place of
    the source's. joints: {key: (6,)} of the YAML. payload: {"mass", "com"}."""
    source = SOURCES[name]
    root = xml.parse(source.urdf()).getroot()
    chain = _chain(root, source.base, source.tip)
    out = xml.Element("robot", name=name)
    out.append(_link(root, source.base))
    turning = []
    for joint in chain:
        copy = _kept(joint, ("parent", "child", "origin", "axis", "limit"))
        if joint.get("type") != "fixed":
            _complete(copy, len(turning), source)
            turning.append(joint.get("name"))
        out.append(copy)
        out.append(_link(root, joint.find("child").get("link")))
    mount = xml.SubElement(out, "joint", name="tool_mount", type="fixed")
    xml.SubElement(mount, "parent", link=source.tip)
    xml.SubElement(mount, "child", link="tool_tip")
    xml.SubElement(mount, "origin", xyz=" ".join(f"{value:.5f}" for value in tool), rpy="0 0 0")
    xml.SubElement(out, "link", name="tool_tip")
    xml.indent(out)
    folder.mkdir(parents=True, exist_ok=True)
    xml.ElementTree(out).write(folder / "robot.urdf", xml_declaration=True, encoding="utf-8")
    springs = source.compliance if compliance is None else compliance
    text = {"schema": "flexcomp/robot/1", "name": name, "urdf": "robot.urdf",
            "base_link": source.base, "tool_link": "tool_tip",
            "gravity": [0.0, 0.0, -9.81 if gravity else 0.0],
            "joints": {joint: {"compliance": float(springs[k])}
                       | {key: float(values[k]) for key, values in (joints or {}).items()}
                       for k, joint in enumerate(turning)}}
    if payload:
        text["payload"] = payload
    (folder / "robot.yaml").write_text(yaml.safe_dump(text, sort_keys=False))


def workable(description):
    """(lower, upper) (6,) rad: where a careful engineer moves the joints."""
    lower, upper = description.column("lower"), description.column("upper")
    return np.maximum(lower + 0.05, -2.8), np.minimum(upper - 0.05, 2.8)
