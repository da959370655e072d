"""Where a written robot's joints and tool stand, for many rows at once: its URDF read anew."""

import dataclasses
import pathlib
import xml.etree.ElementTree as xml

import numpy as np
import yaml

from .geometry import rotation_of


@dataclasses.dataclass
class Stand:
    """Of n rows, base frame."""

    axes: np.ndarray  # (joints, n, 3)
    origins: np.ndarray  # (joints, n, 3)
    turns: np.ndarray  # (joints, n, 3, 3) of the links
    tool: np.ndarray  # (n, 3, 3)
    tip: np.ndarray  # (n, 3)


def _numbers(text):
    return np.array([float(word) for word in text.split()])


def _turn(axis, angle):
    """(n, 3, 3) about an axis (3,) by angles (n,), after Rodrigues."""
    x, y, z = axis
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + sine * skew + (1 - cosine) * (skew @ skew)


def coupled(model):
    """The joints whose drives turn others too, of a robot.yaml."""
    text, found = yaml.safe_load(pathlib.Path(model).read_text()), set()
    for effect in text.get("effects", []):
        if effect["effect"] == "transmission":
            found |= {int(effect["joint"]), int(effect["joint"]) - 1}
    for row, entries in enumerate(text.get("transmission", []), 1):
        found |= {joint for column, entry in enumerate(entries, 1) if column != row and entry
                  for joint in (row, column)}
    return found


class UrdfArm:
    """The chain of a robot.yaml's URDF from base_link to tool_link."""

    def __init__(self, model):
        text = yaml.safe_load(pathlib.Path(model).read_text())
        root = xml.parse(pathlib.Path(model).parent / text["urdf"]).getroot()
        by_child = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
        self._chain, link = [], text["tool_link"]
        while link != text["base_link"]:
            self._chain.insert(0, by_child[link])
            link = by_child[link].find("parent").get("link")
        self.gravity = np.array(text["gravity"], float)
        self.coupled = set()  # joints whose drives turn others too
        self.slides = [joint.get("type") == "prismatic" for joint in self._chain
                       if joint.get("type") != "fixed"]

    @property
    def joints(self):
        return len(self.slides)

    def stand(self, q, longer=None):
        """Stand by joint angles (n, joints). longer: (joint, m) by which a link's end stands further
        along the way to the next joint."""
        n = len(q)
        turn, place = np.broadcast_to(np.eye(3), (n, 3, 3)), np.zeros((n, 3))
        axes, origins, turns = [], [], []
        for element in self._chain:
            origin = element.find("origin")
            step = _numbers(origin.get("xyz"))
            if longer and len(axes) == longer[0]:
                step = step + longer[1] * step / np.linalg.norm(step)
            place = place + turn @ step
            turn = turn @ rotation_of(_numbers(origin.get("rpy")))
            if element.get("type") == "fixed":
                continue
            axis, number = _numbers(element.find("axis").get("xyz")), len(axes)
            axes.append(turn @ axis)
            origins.append(place)
            if element.get("type") == "prismatic":
                place = place + axes[-1] * q[:, number, None]
            else:
                turn = turn @ _turn(axis, q[:, number])
            turns.append(turn)
        return Stand(np.array(axes), np.array(origins), np.array(turns), turn, place)

    def reach(self, joint):
        """m from a joint to the next one, or to the tool."""
        moving = [k for k, each in enumerate(self._chain) if each.get("type") != "fixed"]
        return float(np.linalg.norm(_numbers(self._chain[moving[joint - 1] + 1].find("origin")
                                             .get("xyz"))))
