"""Arms of published robot descriptions (URDF)."""

import math
import xml.etree.ElementTree as xml

import numpy as np

from .chain import Body, Chain, Joint, tensor
from .geometry import Frame, rotation_of
from .tables import Damaged, read_text

TURNS = ("revolute", "continuous")
Z = (0.0, 0.0, 1.0)


def _numbers(text):
    return np.array([float(word) for word in text.split()])


def _frame(element):
    """Of an <origin>; a missing one, or missing parts of it, are none."""
    if element is None:
        return Frame()
    return Frame(rotation_of(_numbers(element.get("rpy", "0 0 0"))),
                 _numbers(element.get("xyz", "0 0 0")))


def _body(link):
    """Of a <link>, or None."""
    inertial = link.find("inertial")
    if inertial is None:
        return None
    entries = inertial.find("inertia")
    about = tensor(*(float(entries.get(name)) for name in ("ixx", "iyy", "izz", "ixy", "iyz", "ixz")))
    body = Body(float(inertial.find("mass").get("value")), np.zeros(3), about)
    return body.seen_from(_frame(inertial.find("origin")))


class _Description:
    def __init__(self, root):
        self._below, self._above = {}, {}
        for joint in root.findall("joint"):
            self._below.setdefault(joint.find("parent").get("link"), []).append(joint)
            self._above[joint.find("child").get("link")] = joint
        self._bodies = {link.get("name"): _body(link) for link in root.findall("link")}

    def way(self, base, tip):
        """Joints from a link to one that hangs on it."""
        joints = []
        while tip != base:
            joints.insert(0, self._above[tip])
            tip = joints[0].find("parent").get("link")
        return joints

    def hanging(self, link, left_out):
        """Bodies of a link and of all that hangs on it, in its frame, but for a joint; joints stand at zero."""
        own = self._bodies[link]
        found = [] if own is None else [own]
        for joint in self._below.get(link, []):
            if joint is not left_out:
                place = _frame(joint.find("origin"))
                found += [body.seen_from(place)
                          for body in self.hanging(joint.find("child").get("link"), None)]
        return found


def _moving(joint, place):
    """A Joint without its bodies."""
    axis = joint.find("axis")
    if axis is None or tuple(_numbers(axis.get("xyz"))) != Z:
        raise ValueError(f"joint '{joint.get('name')}' does not move along or about its z axis")
    limit = joint.find("limit")
    lower, upper = (4 * math.pi * sign if joint.get("type") == "continuous" else float(limit.get(name))
                    for sign, name in ((-1, "lower"), (1, "upper")))
    return Joint(place, [], lower, upper, slides=joint.get("type") == "prismatic")


def _chain(description, name, base, tip):
    way = description.way(base, tip)
    joints, place = [], Frame()
    for joint, following in zip(way, [*way[1:], None]):
        place = place @ _frame(joint.find("origin"))
        if joint.get("type") in (*TURNS, "prismatic"):
            joints.append(_moving(joint, place))
            place = Frame()
        if joints:
            joints[-1].bodies += [body.seen_from(place) for body in
                                  description.hanging(joint.find("child").get("link"), following)]
    return Chain(name, joints, tool=place)


def read_chain(path, name, base, tip):
    """The arm between two links of a URDF. What hangs on its links by other joints is part of them. Raises
    Damaged."""
    try:
        return _chain(_Description(xml.fromstring(read_text(path))), name, base, tip)
    except (xml.ParseError, KeyError, AttributeError, TypeError, ValueError) as error:  # something missing
        raise Damaged(f"{path}: no robot description as published: {error}") from error
