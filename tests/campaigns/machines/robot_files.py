"""Writes a chain as the files that `flexcomp` reads: robot.yaml and its URDF."""

import xml.etree.ElementTree as xml

import yaml

from .chain import joined
from .geometry import rpy_of

# A URDF must state them; they limit nothing here.
EFFORT, SPEED = "100000", "100"  # N·m, rad/s; N, m/s


def _numbers(values):
    return " ".join(f"{value:.12g}" for value in values)


def _add_joint(robot, name, kind, parent, child, place):
    joint = xml.SubElement(robot, "joint", name=name, type=kind)
    xml.SubElement(joint, "parent", link=parent)
    xml.SubElement(joint, "child", link=child)
    xml.SubElement(joint, "origin", xyz=_numbers(place.position),
                   rpy=_numbers(rpy_of(place.rotation)))
    return joint


def _add_link(robot, name, bodies):
    link = xml.SubElement(robot, "link", name=name)
    if bodies:
        body = joined(bodies)
        inertial = xml.SubElement(link, "inertial")
        xml.SubElement(inertial, "origin", xyz=_numbers(body.center))
        xml.SubElement(inertial, "mass", value=f"{body.mass:.12g}")
        entries = {f"i{'xyz'[row]}{'xyz'[column]}": f"{body.inertia[row, column]:.12g}"
                   for row in range(3) for column in range(row, 3)}
        xml.SubElement(inertial, "inertia", entries)


def _urdf(chain):
    robot = xml.Element("robot", name=chain.name.replace(" ", "_"))
    xml.SubElement(robot, "link", name="base_link")
    parent = "base_link"
    for number, joint in enumerate(chain.joints, 1):
        link = f"link_{number}"
        kind = "prismatic" if joint.slides else "revolute"
        element = _add_joint(robot, f"joint_{number}", kind, parent, link, joint.place)
        xml.SubElement(element, "axis", xyz="0 0 1")
        xml.SubElement(element, "limit", lower=f"{joint.lower:.12g}", upper=f"{joint.upper:.12g}",
                       effort=EFFORT, velocity=SPEED)
        _add_link(robot, link, joint.bodies)
        parent = link
    _add_joint(robot, "tool_mount", "fixed", parent, "tool0", chain.tool)
    xml.SubElement(robot, "link", name="tool0")
    xml.indent(robot)
    return robot


def _joint_keys(joint):
    keys = {"compliance": 0.0}
    return keys | {"rotor_inertia": joint.rotor_inertia} if joint.rotor_inertia else keys


def write_robot(folder, chain):
    """robot.yaml and robot.urdf in the folder, made if need be; the path of the former."""
    folder.mkdir(parents=True, exist_ok=True)
    xml.ElementTree(_urdf(chain)).write(folder / "robot.urdf", encoding="unicode")
    document = {
        "schema": "flexcomp/robot/1",
        "name": chain.name,
        "urdf": "robot.urdf",
        "base_link": "base_link",
        "tool_link": "tool0",
        "gravity": [0.0, 0.0, chain.gravity],
        "joints": {f"joint_{number}": _joint_keys(joint)
                   for number, joint in enumerate(chain.joints, 1)},
    }
    path = folder / "robot.yaml"
    path.write_text(yaml.safe_dump(document, sort_keys=False, allow_unicode=True))
    return path
