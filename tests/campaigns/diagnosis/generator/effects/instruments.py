"""Sensors that mislead: the force sensor and the clocks."""

import numpy as np

from ..kinematics import turn
from ..robot import rotation_about
from .base import Effect, direction, log_uniform, signed, unit_probes, vector_parameters

FORCES = ("fx", "fy", "fz")
WRENCH = FORCES + ("mx", "my", "mz")
TURN = ("rx", "ry", "rz")


class WrenchBias(Effect):
    """Force sensor zero, in the tool frame."""

    name = "wrench_bias"
    groups = ("xyz", "tau", "q_link")
    kinds = ("circle", "static", "mixed")
    units = dict.fromkeys(FORCES, "N") | dict.fromkeys(WRENCH[3:], "N·m")

    def draw(self, rng, joint, robot, scale):
        force = scale.force * log_uniform(rng, 0.04, 0.3) * direction(rng)
        return vector_parameters(WRENCH, np.concatenate([force, 0.02 * scale.force * rng.uniform(
            0, 0.3) * direction(rng)]))

    def apply(self, machine, joint, parameters):
        bias = np.array([parameters[name] for name in WRENCH])
        machine.sensor.append(lambda local: local + bias)

    def probes(self, joint, robot, scale):
        return [unit_probes(WRENCH, 0.05 * max(scale.force, 1.0))]


class WrenchScale(Effect):
    """Force sensor gain: reads `gain` times the truth."""

    name = "wrench_scale"
    groups = ("xyz", "tau", "q_link")
    kinds = ("circle", "static", "mixed")
    units = {"gain": "1"}

    def draw(self, rng, joint, robot, scale):
        return {"gain": 1 + signed(rng, 0.06, 0.4)}

    def apply(self, machine, joint, parameters):
        machine.sensor.append(lambda local: local * parameters["gain"])

    def probes(self, joint, robot, scale):
        return [[{"gain": 1.1}]]


class WrenchFrame(Effect):
    """Force sensor mounted rotated: it reads the wrench turned by a rotation vector, tool frame."""

    name = "wrench_frame"
    groups = ("xyz", "tau", "q_link")
    kinds = ("circle", "static", "mixed")
    units = dict.fromkeys(TURN, "rad")

    def draw(self, rng, joint, robot, scale):
        about = np.array([0, 0, 1.0]) + 0.3 * rng.normal(size=3)
        return vector_parameters(TURN, signed(rng, 0.05, 0.5) * about / np.linalg.norm(about))

    def apply(self, machine, joint, parameters):
        vector = np.array([parameters[name] for name in TURN])
        angle = np.linalg.norm(vector)
        rotation = rotation_about(vector / angle, angle)

        def read(local):
            return np.concatenate([turn(rotation, local[:, :3]),
                                   turn(rotation, local[:, 3:])], 1)

        machine.sensor.append(read)

    def probes(self, joint, robot, scale):
        return [unit_probes(TURN, 0.05)]


class TimeOffset(Effect):
    """One group of columns comes late against the encoders."""

    name = "time_offset"
    groups = ("xyz", "tau", "q_link")
    kinds = ("circle", "air", "torque", "mixed")
    units = {"delay": "s"}
    LATE = ("xyz", "tau", "wrench")

    def draw(self, rng, joint, robot, scale):
        return {"delay": signed(rng, 4e-3, 60e-3), "group": str(rng.choice(self.LATE))}

    def apply(self, machine, joint, parameters):
        machine.late[parameters["group"]] = parameters["delay"]

    def probes(self, joint, robot, scale):
        return [[{"delay": 10e-3, "group": group}] for group in self.LATE]


EFFECTS = (WrenchBias(), WrenchScale(), WrenchFrame(), TimeOffset())
