"""The robot as its files describe it: URDF and YAML (schema flexcomp/robot/1) as plain numbers."""

import dataclasses
import pathlib
import xml.etree.ElementTree as xml

import numpy as np
import yaml
from scipy.spatial.transform import Rotation


@dataclasses.dataclass
class Body:
    """One URDF link: mass (kg), centre of mass (m) and inertia about it (kg·m²), link frame."""

    mass: float
    center: np.ndarray  # (3,)
    inertia: np.ndarray  # (3, 3)


@dataclasses.dataclass
class Joint:
    """A revolute joint, or a fixed one (axis None), with the link it moves."""

    name: str
    position: np.ndarray  # (3,) m, in the frame of the link before
    rotation: np.ndarray  # (3, 3)
    axis: np.ndarray | None  # (3,), link frame
    body: Body | None
    lower: float = 0.0  # rad
    upper: float = 0.0
    speed: float = 0.0  # rad/s
    effort: float = 0.0  # N·m
    compliance: float = 0.0  # rad/(N·m)
    viscous: float = 0.0  # N·m·s/rad
    coulomb: float = 0.0  # N·m
    rotor_inertia: float = 0.0  # kg·m², joint side


@dataclasses.dataclass
class Description:
    """The chain from base to tool; every quantity in SI units."""

    name: str
    gravity: np.ndarray  # (3,) m/s², base frame
    chain: list  # of Joint, base to tip, fixed ones among them
    payload_mass: float
    payload_center: np.ndarray  # (3,) m, tool frame

    @property
    def joints(self):
        """The six that turn."""
        return [joint for joint in self.chain if joint.axis is not None]

    def column(self, name):
        """One number of each revolute joint (6,)."""
        return np.array([getattr(joint, name) for joint in self.joints])


def _vector(element, name, default="0 0 0"):
    text = default if element is None else element.get(name, default)
    return np.array([float(value) for value in text.split()])


def _rotation(element):
    """URDF: roll, pitch, yaw about fixed axes."""
    return Rotation.from_euler("xyz", _vector(element, "rpy")).as_matrix()


def _body(link):
    inertial = link.find("inertial")
    if inertial is None:
        return None
    turn = _rotation(inertial.find("origin"))
    entry = {key: float(value) for key, value in inertial.find("inertia").attrib.items()}
    tensor = np.array([[entry["ixx"], entry["ixy"], entry["ixz"]],
                       [entry["ixy"], entry["iyy"], entry["iyz"]],
                       [entry["ixz"], entry["iyz"], entry["izz"]]])
    return Body(float(inertial.find("mass").get("value")), _vector(inertial.find("origin"), "xyz"),
                turn @ tensor @ turn.T)


def _joint(element, links, springs):
    origin = element.find("origin")
    joint = Joint(element.get("name"), _vector(origin, "xyz"), _rotation(origin), None,
                  _body(links[element.find("child").get("link")]))
    if element.get("type") == "fixed":
        return joint
    axis = _vector(element.find("axis"), "xyz", "1 0 0")
    limit = element.find("limit")
    joint.axis = axis / np.linalg.norm(axis)
    joint.lower, joint.upper = float(limit.get("lower")), float(limit.get("upper"))
    joint.speed, joint.effort = float(limit.get("velocity")), float(limit.get("effort"))
    for name in ("compliance", "viscous", "coulomb", "rotor_inertia"):
        setattr(joint, name, float(springs[joint.name].get(name, 0.0)))
    return joint


def load(path):
    """The Description in a robot.yaml and the URDF that it names."""
    path = pathlib.Path(path)
    text = yaml.safe_load(path.read_text())
    root = xml.parse(path.parent / text["urdf"]).getroot()
    links = {link.get("name"): link for link in root.findall("link")}
    by_child = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
    chain, link = [], text["tool_link"]
    while link != text["base_link"]:
        element = by_child[link]
        chain.insert(0, _joint(element, links, text["joints"]))
        link = element.find("parent").get("link")
    payload = text.get("payload", {})
    return Description(text["name"], np.array(text.get("gravity", [0, 0, 0]), float), chain,
                       float(payload.get("mass", 0.0)),
                       np.array(payload.get("com", [0, 0, 0]), float))
