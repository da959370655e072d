"""Springs that differ from the model's or are missing from it."""

import numpy as np

from ..elasticity import Spring, beam
from ..kinematics import BASE, TOOL
from .base import ALL_JOINTS, Effect, log_uniform, unit_probes


class JointStiffness(Effect):
    name = "joint_stiffness"
    alters_model = True
    joints = ALL_JOINTS
    groups = ("xyz", "q_link")
    kinds = ("circle", "link", "static", "mixed")
    units = {"compliance": "rad/(N·m)"}

    def draw(self, rng, joint, robot, scale):
        factor = rng.uniform(1.25, 2.5) if rng.random() < 0.7 else rng.uniform(0.4, 0.75)
        return {"compliance": float(factor * robot.compliance[joint - 1])}

    def apply(self, machine, joint, parameters):
        machine.robot.compliance[joint - 1] = parameters["compliance"]

    def probes(self, joint, robot, scale):
        return [[{"compliance": 1.3 * robot.compliance[joint - 1]}]]


class NonlinearStiffness(Effect):
    """deflection = c1·tau + c3·tau^3."""

    name = "nonlinear_stiffness"
    alters_model = True
    joints = ALL_JOINTS
    groups = ("xyz", "q_link")
    kinds = ("circle", "link", "static", "mixed")
    units = {"cubic_compliance": "rad/(N·m)^3"}

    def draw(self, rng, joint, robot, scale):
        share = rng.uniform(0.3, 1.2) if rng.random() < 0.75 else -rng.uniform(0.2, 0.3)
        k = joint - 1
        return {"cubic_compliance": float(share * robot.compliance[k] / scale.load[k] ** 2)}

    def apply(self, machine, joint, parameters):
        machine.robot.cubic[joint - 1] += parameters["cubic_compliance"]

    def probes(self, joint, robot, scale):
        k = joint - 1
        return [[{"cubic_compliance": 0.3 * robot.compliance[k] / scale.load[k] ** 2}]]


class LinkFlexibility(Effect):
    """The link that the joint moves bends or twists: springs across the joint's axis at its root, or
    a cantilever beam as long as the link."""

    name = "link_flexibility"
    joints = (1, 2, 3, 4, 5)
    groups = ("xyz",)
    kinds = ("circle", "static", "mixed")
    units = {"x": "rad/(N·m)", "y": "rad/(N·m)", "z": "rad/(N·m)", "beam": "rad/(N·m)"}
    AXES = ("x", "y", "z")

    def _across(self, joint, robot):
        return [k for k in range(3) if abs(robot.axis[joint - 1][k]) < 0.5]

    def draw(self, rng, joint, robot, scale):
        size = log_uniform(rng, 1.5e-7, 1.5e-6)
        parameters = dict.fromkeys(self.AXES, 0.0) | {"beam": 0.0}
        length = np.linalg.norm(robot.origin[joint]) if joint < 6 else 0
        if length > 0.3 and rng.random() < 0.3:
            parameters["beam"] = size
            return parameters
        for k in self._across(joint, robot):
            parameters[self.AXES[k]] = size * rng.uniform(0.2, 1.0)
        return parameters

    def apply(self, machine, joint, parameters):
        compliance = np.diag([0, 0, 0] + [parameters[axis] for axis in self.AXES]).astype(float)
        if parameters["beam"]:
            compliance += beam(machine.robot.origin[joint], parameters["beam"])
        machine.springs.append(Spring(joint, compliance))

    def probes(self, joint, robot, scale):
        members = []
        for k in self._across(joint, robot):
            members.append(dict.fromkeys(self.AXES, 0.0) | {"beam": 0.0, self.AXES[k]: 3e-7})
        return [members]


SIX = ("x", "y", "z", "rx", "ry", "rz")
SIX_UNITS = dict.fromkeys(SIX[:3], "m/N") | dict.fromkeys(SIX[3:], "rad/(N·m)")


class BaseCompliance(Effect):
    name = "base_compliance"
    groups = ("xyz",)
    kinds = ("circle", "static", "mixed")
    units = SIX_UNITS

    def draw(self, rng, joint, robot, scale):
        move, turn = log_uniform(rng, 5e-9, 5e-8), log_uniform(rng, 1e-8, 1.5e-7)
        sizes = [move] * 3 + [turn, turn, 0.5 * turn]
        return {name: float(size * rng.uniform(0.3, 1.0)) for name, size in zip(SIX, sizes)}

    def apply(self, machine, joint, parameters):
        machine.springs.append(Spring(BASE, np.diag([parameters[name] for name in SIX])))

    def probes(self, joint, robot, scale):
        return [unit_probes(SIX, 5e-8)]


class ToolCompliance(Effect):
    """Only the translations move the TCP."""

    name = "tool_compliance"
    groups = ("xyz",)
    kinds = ("circle", "static", "mixed")
    units = dict.fromkeys(SIX[:3], "m/N")

    def draw(self, rng, joint, robot, scale):
        size = log_uniform(rng, 5e-8, 5e-7)
        return {name: float(size * rng.uniform(0.2, 1.0)) for name in SIX[:3]}

    def apply(self, machine, joint, parameters):
        entries = [parameters[name] for name in SIX[:3]] + [0.0] * 3
        machine.springs.append(Spring(TOOL, np.diag(entries)))

    def probes(self, joint, robot, scale):
        return [unit_probes(SIX[:3], 1e-7)]


EFFECTS = (JointStiffness(), NonlinearStiffness(), LinkFlexibility(), BaseCompliance(),
           ToolCompliance())
