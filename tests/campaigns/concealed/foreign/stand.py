"""Things that stand elsewhere than the model says."""

import dataclasses

import numpy as np
from scipy.spatial.transform import Rotation

from .law import Foreign, lagged, law

AXES = "xyz"


class JointAngle(Foreign):
    """One joint's."""

    undone = True

    def places(self):
        return [("joint_angle", self.joint), ("joint_windup", self.joint)]


class ZeroByLoad(JointAngle):
    """A joint stands elsewhere by what another carries: shift·load_driver, shift in rad/(N·m)."""

    name = "zero_by_load"

    def angle(self, seen):
        return self.parameters["shift"] * seen.of("load", self.parameters["driver"])

    def laws(self):
        return [law("joint_angle", f"-k*tau{self.parameters['driver']:.0f}", joint=self.joint,
                    k=self.parameters["shift"])]


class EccentricEncoder(JointAngle):
    """The joint stands at its encoder's reading plus first·sin(q + first_phase)
    + second·sin(2 q + second_phase), rad."""

    name = "eccentric_encoder"
    kin = ("transmission_ripple",)

    def error(self, q):
        own = self.parameters
        return (own["first"] * np.sin(q + own["first_phase"])
                + own["second"] * np.sin(2 * q + own["second_phase"]))

    def driven(self, motion):
        q = motion.q.copy()
        q[:, self.joint - 1] += self.error(q[:, self.joint - 1])
        return dataclasses.replace(motion, q=q)

    def sense(self, signals, description):
        column = signals.q_meas[:, self.joint - 1]
        column -= self.error(column)

    def laws(self):
        own, q = self.parameters, f"q{self.joint}"
        return [law("joint_angle", f"a*sin({q}+b)+c*sin(2*{q}+d)", joint=self.joint, a=own["first"],
                    b=own["first_phase"], c=own["second"], d=own["second_phase"])]


class Creep(JointAngle):
    """A gear gives way slowly: compliance·load with a lag of `time` s."""

    name = "creep"

    def angle(self, seen):
        own = self.parameters
        return own["compliance"] * lagged(seen.time, seen.of("load", self.joint), own["time"])

    def laws(self):
        own = self.parameters
        return [law("joint_angle", f"-c*lag(tau{self.joint},T)", joint=self.joint,
                    c=own["compliance"], T=own["time"])]


class BentRail(Foreign):
    """The floor is bent: the TCP stands off along axis `axis` (0 to 2, base frame) by
    bow·s² + skew·s³, s = its coordinate `along` - middle; 1/m, 1/m²."""

    name = "bent_rail"
    undone = True

    def error(self, place):
        """(n,) m at places (n, 3)."""
        own = self.parameters
        s = place[:, int(own["along"])] - own["middle"]
        return own["bow"] * s**2 + own["skew"] * s**3

    def moved(self, seen, place):
        shift = np.zeros_like(place)
        shift[:, int(self.parameters["axis"])] = self.error(place)
        return place + shift

    def places(self):
        axis = AXES[int(self.parameters["axis"])]
        return [("tcp_base", axis), ("base", axis), (f"sensor {axis}", None)]

    def laws(self):
        own = self.parameters
        s = f"({AXES[int(own['along'])]}-m)"
        return [law("tcp_base", f"b*{s}^2+c*{s}^3", axis=AXES[int(own["axis"])], b=own["bow"],
                    c=own["skew"], m=own["middle"])]


class SoftFloor(Foreign):
    """The floor is soft on one side: the base turns about axis `axis` (0: x, 1: y) by
    tilt·max(0, cos(q1 - side)), rad."""

    name = "soft_floor"
    undone = True

    def tilt(self, q):
        """(n,) rad by the first joint's angle."""
        return self.parameters["tilt"] * np.maximum(0.0, np.cos(q - self.parameters["side"]))

    def moved(self, seen, place):
        axis = np.eye(3)[int(self.parameters["axis"])]
        turn = Rotation.from_rotvec(np.outer(self.tilt(seen.of("q", 1)), axis))
        return turn.apply(place)

    def places(self):
        return [("base", "r" + AXES[int(self.parameters["axis"])])]

    def laws(self):
        own = self.parameters
        return [law("base", "k*max(0,cos(q1-p))", axis="r" + AXES[int(own["axis"])], k=own["tilt"],
                    p=own["side"])]
