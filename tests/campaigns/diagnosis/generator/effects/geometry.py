"""The robot is not where the model has it."""

import numpy as np

from ..kinematics import turn
from .base import (ALL_JOINTS, Effect, direction, log_uniform, signed, unit_probes,
                   vector_parameters)

XYZ = ("x", "y", "z")


class JointOffset(Effect):
    """Encoder zero: the joint stands at its reading plus the offset."""

    name = "joint_offset"
    joints = ALL_JOINTS
    groups = ("xyz", "q_link")
    kinds = ("circle", "air", "link", "static", "mixed")
    units = {"offset": "rad"}

    def draw(self, rng, joint, robot, scale):
        return {"offset": signed(rng, 1e-4, 3e-3)}

    def apply(self, machine, joint, parameters):
        machine.zero[joint - 1] += parameters["offset"]

    def probes(self, joint, robot, scale):
        return [[{"offset": 3e-4}]]


class LinkLength(Effect):
    """The link that the joint moves is longer, along the line to the next joint."""

    name = "link_length"
    alters_model = True
    joints = (1, 2, 3, 4, 5)
    groups = ("xyz",)
    kinds = ("circle", "air", "static", "mixed")
    units = {"length": "m"}

    def draw(self, rng, joint, robot, scale):
        return {"length": signed(rng, 1.5e-4, 2e-3)}

    def apply(self, machine, joint, parameters):
        origin = machine.robot.origin[joint]
        origin += parameters["length"] * origin / np.linalg.norm(origin)

    def probes(self, joint, robot, scale):
        return [[{"length": 5e-4}]]


class TcpOffset(Effect):
    name = "tcp_offset"
    groups = ("xyz",)
    kinds = ("circle", "air", "static", "mixed")
    units = dict.fromkeys(XYZ, "m")

    def draw(self, rng, joint, robot, scale):
        return vector_parameters(XYZ, log_uniform(rng, 1.5e-4, 2e-3) * direction(rng))

    def apply(self, machine, joint, parameters):
        offset = np.array([parameters[name] for name in XYZ])
        machine.shift.append(lambda state, rotation: turn(rotation, offset))

    def probes(self, joint, robot, scale):
        return [unit_probes(XYZ, 5e-4)]


class ThermalDrift(Effect):
    """The structure grows as it warms: the TCP moves in a fixed direction of the base frame, in
    proportion to the rise of temperature."""

    name = "thermal_drift"
    groups = ("xyz",)
    kinds = ("circle", "air", "static", "mixed")
    hints = {"warming": True}
    units = dict.fromkeys(XYZ, "m/K")

    def draw(self, rng, joint, robot, scale):
        return vector_parameters(XYZ, log_uniform(rng, 5e-6, 4e-5) * direction(rng))

    def apply(self, machine, joint, parameters):
        growth = np.array([parameters[name] for name in XYZ])
        machine.shift.append(
            lambda state, rotation: np.outer(state.temperature - state.temperature[0], growth))

    def probes(self, joint, robot, scale):
        return [unit_probes(XYZ, 1e-5)]


EFFECTS = (JointOffset(), LinkLength(), TcpOffset(), ThermalDrift())
