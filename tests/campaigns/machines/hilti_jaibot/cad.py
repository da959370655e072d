"""The CAD model of the JaiBot: its published URDF, at one height of the column."""

import xml.etree.ElementTree as xml

import numpy as np

from ..chain import JOINTS, Body, Chain, Joint
from ..geometry import Frame, rotation_of
from ..tables import Damaged, read_text

FOOT = "column_base"
ROUNDED = 1e-3  # rad: the CAD writes right angles as 1.571


def _vector(element, name):
    return np.array([float(number) for number in element.get(name).split()])


def _rotation(origin):
    """With angles that are a right angle but for their rounding set right: 0.6 mm at the prism."""
    rpy = _vector(origin, "rpy")
    right = np.round(rpy / (np.pi / 2)) * np.pi / 2
    return rotation_of(np.where(np.abs(rpy - right) < ROUNDED, right, rpy))


class Cad:
    def __init__(self, path):
        try:
            root = xml.fromstring(read_text(path))
            self._joint_above = {joint.find("child").get("link"): joint
                                 for joint in root.findall("joint")}
            self._bodies = {link.get("name"): self._body(link.find("inertial"))
                            for link in root.findall("link") if link.find("inertial") is not None}
        except (xml.ParseError, AttributeError, ValueError) as error:
            raise Damaged(f"{path}: is no robot description ({error})") from error
        self._path = path

    @staticmethod
    def _body(inertial):
        """A point mass: nothing here moves."""
        mass = float(inertial.find("mass").get("value"))
        return Body(mass, _vector(inertial.find("origin"), "xyz"))

    def _step(self, link, column):
        """A link's frame in its parent's; the arm at zero, the column at a height (m)."""
        if link not in self._joint_above:
            raise Damaged(f"{self._path}: link '{link}' does not hang on '{FOOT}'")
        joint = self._joint_above[link]
        origin = joint.find("origin")
        frame = Frame(_rotation(origin), _vector(origin, "xyz"))
        if joint.get("type") != "prismatic":
            return frame
        mimic = joint.find("mimic")
        height = column if mimic is None else (
            float(mimic.get("multiplier")) * column + float(mimic.get("offset")))
        return frame @ Frame(position=_vector(joint.find("axis"), "xyz") * height)

    def between(self, first, last, column):
        """The frame of link `last` in that of link `first`, one of those that bear it."""
        frame = Frame()
        while last != first:
            frame = self._step(last, column) @ frame
            last = self._joint_above[last].find("parent").get("link")
        return frame

    def chain(self, name, column):
        """The arm on its column, seen from the column's foot; the TCP is the prism."""
        joints, before = [], FOOT
        for number in range(1, JOINTS + 1):
            link = f"dsr_link{number}"
            place = self.between(before, link, column)
            if link not in self._bodies:
                raise Damaged(f"{self._path}: link '{link}' has no mass")
            joints.append(Joint(place, [self._bodies[link]]))
            before = link
        tool = self.between(before, "tool_link", column)
        joints[-1].bodies.append(self._bodies["tool_link"].seen_from(tool))
        return Chain(name, joints, tool=self.between(before, "prism", column))
