"""A machine of joints that turn or slide, as a reader describes it."""

import dataclasses
import math

import numpy as np

from .geometry import Frame, moved, turned

JOINTS = 6  # of most arms


def tensor(xx, yy, zz, xy, yz, xz):
    """Its entries as they stand -> (3, 3)."""
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


@dataclasses.dataclass
class Body:
    """A rigid body in a frame: mass in kg, its centre (3,) in m, inertia about that (3, 3) in
    kg·m²."""

    mass: float
    center: np.ndarray
    inertia: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros((3, 3)))

    def seen_from(self, frame):
        """The same body in the frame in which this one's frame lies at `frame`."""
        turned_inertia = frame.rotation @ self.inertia @ frame.rotation.T
        return Body(self.mass, frame.at(self.center), turned_inertia)


def joined(bodies):
    """Bodies of one frame as one (Huygens and Steiner)."""
    mass = sum(body.mass for body in bodies)
    center = sum(body.mass * np.asarray(body.center) for body in bodies) / mass
    inertia = np.zeros((3, 3))
    for body in bodies:
        arm = np.asarray(body.center) - center
        inertia += body.inertia + body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
    return Body(mass, center, inertia)


@dataclasses.dataclass
class Joint:
    """A joint that turns about its frame's z axis or slides along it, and what hangs on the link
    that it moves.

    place: the joint's frame in the frame of the joint before it; bodies: in the joint's frame.
    """

    place: Frame
    bodies: list = dataclasses.field(default_factory=list)
    lower: float = -4 * math.pi  # rad, or m
    upper: float = 4 * math.pi
    rotor_inertia: float = 0.0  # kg·m² or kg, reflected to the joint
    slides: bool = False


@dataclasses.dataclass
class Chain:
    """Joints, base to tip; tool: the TCP in the last joint's frame."""

    name: str
    joints: list
    tool: Frame
    gravity: float = -9.81  # m/s², along the base's z

    def frames(self, angles):
        """The joints' frames, moved, and the tool's, in the base; angles (joints,) in rad or m."""
        found = [Frame()]
        for joint, angle in zip(self.joints, angles, strict=True):
            motion = moved(z=angle) if joint.slides else turned("z", angle)
            found.append(found[-1] @ joint.place @ motion)
        return found[1:] + [found[-1] @ self.tool]


def by_standard_parameters(rows, base=Frame(), zeros=(0.0,) * JOINTS):
    """Denavit and Hartenberg's parameters -> joints' places, and far ends of the links in them.

    rows: a (m), d (m), alpha (rad) of each link; base: the first joint's place; zeros: the angle
    (rad) of the parameters where the joint's own is zero.
    """
    places, ends, before = [], [], base
    for (length, offset, twist), zero in zip(rows, zeros, strict=True):
        places.append(before @ turned("z", zero))
        before = Frame(position=np.array([length, 0.0, offset])) @ turned("x", twist)
        ends.append(before)
    return places, ends


def by_modified_parameters(rows):
    """Craig's modification of these parameters, a and alpha before the joint -> joints' places."""
    return [turned("x", twist) @ Frame(position=np.array([length, 0.0, offset]))
            for length, offset, twist in rows]
