"""The robot as its YAML and URDF describe it."""

import copy
import dataclasses
import pathlib
import xml.etree.ElementTree as xml

import numpy as np
import yaml

JOINTS = 6


@dataclasses.dataclass
class Body:
    """A rigid body that moves with a link: com and inertia (about the com) in the link's frame."""

    mass: float
    com: np.ndarray
    inertia: np.ndarray


@dataclasses.dataclass
class Robot:
    """Six revolute joints. Link k's frame lies at joint k and turns with it; SI units."""

    origin_rotation: np.ndarray  # (6, 3, 3), joint frame in its parent link's frame
    origin: np.ndarray  # (6, 3)
    axis: np.ndarray  # (6, 3), unit, joint frame
    lower: np.ndarray
    upper: np.ndarray
    speed: np.ndarray
    effort: np.ndarray
    tool_rotation: np.ndarray  # (3, 3), TCP frame in link 6
    tool: np.ndarray  # (3,)
    bodies: list  # of six lists of Body
    gravity: np.ndarray
    compliance: np.ndarray  # rad/(N·m)
    cubic: np.ndarray  # rad/(N·m)^3
    viscous: np.ndarray
    coulomb: np.ndarray
    rotor: np.ndarray
    base_compliance: np.ndarray  # (6,)
    tool_compliance: np.ndarray  # (6,)

    def copy(self):
        return copy.deepcopy(self)


def rotation_about(axis, angle):
    """Rodrigues' formula. axis (3,), angle (...) in rad -> (..., 3, 3)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.asarray(angle)[..., None, None]
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * (cross @ cross)


def rpy(angles):
    """URDF's roll, pitch, yaw about fixed axes -> (3, 3)."""
    roll, pitch, yaw = angles
    return (rotation_about((0, 0, 1), yaw) @ rotation_about((0, 1, 0), pitch)
            @ rotation_about((1, 0, 0), roll))


def _numbers(text):
    return np.array([float(word) for word in text.split()])


def _origin(element):
    origin = element.find("origin") if element is not None else None
    if origin is None:
        return np.eye(3), np.zeros(3)
    return rpy(_numbers(origin.get("rpy", "0 0 0"))), _numbers(origin.get("xyz", "0 0 0"))


def _body(link, rotation, position):
    """The link's body, seen from a frame in which the link stands at rotation, position; or None."""
    inertial = link.find("inertial")
    if inertial is None:
        return None
    turn, com = _origin(inertial)
    entry = {key: float(value) for key, value in inertial.find("inertia").attrib.items()}
    tensor = np.array([[entry["ixx"], entry["ixy"], entry["ixz"]],
                       [entry["ixy"], entry["iyy"], entry["iyz"]],
                       [entry["ixz"], entry["iyz"], entry["izz"]]])
    turn = rotation @ turn
    return Body(float(inertial.find("mass").get("value")), position + rotation @ com,
                turn @ tensor @ turn.T)


def _chain(joints, base, tip):
    """The joint elements from base to tip."""
    by_child = {joint.find("child").get("link"): joint for joint in joints}
    found = []
    while tip != base:
        found.append(by_child[tip])
        tip = by_child[tip].find("parent").get("link")
    return found[::-1]


def load(path):
    """Reads a robot.yaml and its URDF."""
    path = pathlib.Path(path)
    text = yaml.safe_load(path.read_text())
    tree = xml.parse(path.parent / text["urdf"]).getroot()
    links = {link.get("name"): link for link in tree.findall("link")}
    chain = _chain(tree.findall("joint"), text["base_link"], text["tool_link"])

    rotation, position = np.eye(3), np.zeros(3)
    origins, names, limits, axes, bodies = [], [], [], [], []
    for joint in chain:
        turn, shift = _origin(joint)
        position, rotation = position + rotation @ shift, rotation @ turn
        if joint.get("type") == "revolute":
            origins.append((rotation, position))
            names.append(joint.get("name"))
            limits.append(joint.find("limit").attrib)
            axis = _numbers(joint.find("axis").get("xyz"))
            axes.append(axis / np.linalg.norm(axis))
            bodies.append([])
            rotation, position = np.eye(3), np.zeros(3)
        body = _body(links[joint.find("child").get("link")], rotation, position)
        if body is not None and bodies:
            bodies[-1].append(body)

    payload = text.get("payload", {"mass": 0.0, "com": [0, 0, 0]})
    if payload["mass"]:
        com = position + rotation @ np.array(payload["com"], float)
        bodies[-1].append(Body(float(payload["mass"]), com, np.zeros((3, 3))))

    def each(key):
        return np.array([float(text["joints"][name].get(key, 0.0)) for name in names])

    def limit(key):
        return np.array([float(entry[key]) for entry in limits])

    return Robot(
        origin_rotation=np.array([turn for turn, _ in origins]),
        origin=np.array([shift for _, shift in origins]), axis=np.array(axes),
        lower=limit("lower"), upper=limit("upper"), speed=limit("velocity"), effort=limit("effort"),
        tool_rotation=rotation, tool=position, bodies=bodies,
        gravity=np.array(text.get("gravity", [0, 0, 0]), float),
        compliance=each("compliance"), cubic=each("cubic_compliance"), viscous=each("viscous"),
        coulomb=each("coulomb"), rotor=each("rotor_inertia"),
        base_compliance=np.array(text.get("base_compliance", np.zeros(6)), float),
        tool_compliance=np.array(text.get("tool_compliance", np.zeros(6)), float))
