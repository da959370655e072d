"""Torques that a drive must give besides."""

import numpy as np

from .law import Foreign, law

SMOOTH_SPEED = 3e-3  # rad/s over which friction turns round
SMOOTH_POWER = 1e-4  # rad²/s³ over which braking turns into driving


class DriveTorque(Foreign):
    """One joint's drive."""

    def places(self):
        return [("joint_torque", self.joint), ("sensor tau", self.joint)]

    def _law(self, formula, **values):
        return [law("joint_torque", formula, joint=self.joint, **values)]


def _direction(speed):
    return np.tanh(speed / SMOOTH_SPEED)


class Hose(DriveTorque):
    """A hose turns with joint `driver` and pulls at this one: torque·sin(q_driver - rest)."""

    name = "hose"

    def extra(self, seen):
        own = self.parameters
        return own["torque"] * np.sin(seen.of("q", own["driver"]) - own["rest"])

    def laws(self):
        own = self.parameters
        return self._law(f"a*sin(q{own['driver']:.0f}-p)", a=own["torque"], p=own["rest"])


class CoupledCogging(DriveTorque):
    """Cogging that another joint makes larger, smaller and turns round:
    torque·sin(order·q + phase)·cos(2 (q_driver - middle))."""

    name = "coupled_cogging"

    def extra(self, seen):
        own = self.parameters
        wave = np.sin(own["order"] * seen.of("q", self.joint) + own["phase"])
        return own["torque"] * wave * np.cos(2 * (seen.of("q", own["driver"]) - own["middle"]))

    def laws(self):
        own = self.parameters
        return self._law(f"a*sin(n*q{self.joint}+p)*cos(2*(q{own['driver']:.0f}-m))",
                         a=own["torque"], n=own["order"], p=own["phase"], m=own["middle"])


class Windage(DriveTorque):
    """Another joint's speed leaks in, squared: drag·v_driver·|v_driver|."""

    name = "windage"

    def extra(self, seen):
        speed = seen.of("v", self.parameters["driver"])
        return self.parameters["drag"] * speed * np.abs(speed)

    def laws(self):
        v = f"v{self.parameters['driver']:.0f}"
        return self._law(f"k*{v}*abs({v})", k=self.parameters["drag"])


class Detent(DriveTorque):
    """A magnet holds the joint at one angle: torque·s·exp((1 - s²)/2), s = (q - angle)/width."""

    name = "detent"

    def extra(self, seen):
        own = self.parameters
        s = (seen.of("q", self.joint) - own["angle"]) / own["width"]
        return own["torque"] * s * np.exp((1 - s**2) / 2)

    def laws(self):
        own, s = self.parameters, f"((q{self.joint}-c)/w)"
        return self._law(f"a*{s}*exp((1-{s}^2)/2)", a=own["torque"], c=own["angle"], w=own["width"])


class SoftStop(DriveTorque):
    """A spring beyond an angle: stiffness·(q - angle) where side·(q - angle) > 0."""

    name = "soft_stop"

    def extra(self, seen):
        own = self.parameters
        beyond = own["side"] * (seen.of("q", self.joint) - own["angle"])
        return own["stiffness"] * own["side"] * np.maximum(beyond, 0)

    def laws(self):
        own = self.parameters
        return self._law(f"s*k*max(0,s*(q{self.joint}-c))", k=own["stiffness"], c=own["angle"],
                         s=own["side"])


class WornStretch(DriveTorque):
    """Dry friction in one part of the travel: torque·sign(v)·exp(-((q - angle)/width)²)."""

    name = "worn_stretch"

    def extra(self, seen):
        own = self.parameters
        s = (seen.of("q", self.joint) - own["angle"]) / own["width"]
        return own["torque"] * _direction(seen.of("v", self.joint)) * np.exp(-(s**2))

    def laws(self):
        own, j = self.parameters, self.joint
        return self._law(f"a*sign(v{j})*exp(-((q{j}-c)/w)^2)", a=own["torque"], c=own["angle"],
                         w=own["width"])


class DrivingFriction(DriveTorque):
    """Dry friction of a gear that is driven, none while it brakes: torque·sign(v) where v·a > 0."""

    name = "driving_friction"

    def extra(self, seen):
        speed, push = seen.of("v", self.joint), seen.of("a", self.joint)
        drives = 0.5 * (1 + np.tanh(speed * push / SMOOTH_POWER))
        return self.parameters["torque"] * _direction(speed) * drives

    def laws(self):
        j = self.joint
        return self._law(f"f*sign(v{j})*step(v{j}*a{j})", f=self.parameters["torque"])


class NeighbourFriction(DriveTorque):
    """Dry friction by what another joint carries: share·|load_driver|·sign(v)."""

    name = "neighbour_friction"

    def extra(self, seen):
        load = np.abs(seen.of("load", self.parameters["driver"]))
        return self.parameters["share"] * load * _direction(seen.of("v", self.joint))

    def laws(self):
        driver = f"{self.parameters['driver']:.0f}"
        return self._law(f"s*abs(tau{driver})*sign(v{self.joint})", s=self.parameters["share"])
