"""Masses, and what balances them."""

import numpy as np

from ..robot import Body
from .base import ALL_JOINTS, Effect, direction, log_uniform, signed, unit_probes

MOMENT = ("mass", "mx", "my", "mz")  # kg, and first moment about the link's (or tool) frame in kg·m
MOMENT_UNITS = {"mass": "kg", "mx": "kg·m", "my": "kg·m", "mz": "kg·m"}
INERTIAL_KINDS = ("torque", "link", "static", "mixed")


def _moment(parameters):
    return np.array([parameters[name] for name in MOMENT[1:]])


def _add_moment(robot, k, mass, moment):
    """Adds mass and first moment (link frame) to link k as two point masses, which may be negative."""
    far = 1.0  # m; the pair carries the moment, the first point the mass
    size = np.linalg.norm(moment)
    nothing = np.zeros((3, 3))
    robot.bodies[k].append(Body(mass, np.zeros(3), nothing))
    if size:
        tip = 0.5 * far * moment / size
        robot.bodies[k] += [Body(size / far, tip, nothing), Body(-size / far, -tip, nothing)]


class Payload(Effect):
    """The load of the flange differs from the model's: mass and first moment in the tool frame."""

    name = "payload"
    alters_model = True
    groups = ("xyz", "tau", "q_link")
    kinds = INERTIAL_KINDS
    hints = {"gravity": True}
    units = MOMENT_UNITS

    def draw(self, rng, joint, robot, scale):
        mass = log_uniform(rng, 10, 150)
        com = np.array([0, 0, rng.uniform(0.02, 0.25)]) + 0.08 * rng.normal(size=3)
        return {"mass": mass} | dict(zip(MOMENT[1:], (mass * com).tolist()))

    def apply(self, machine, joint, parameters):
        robot = machine.robot
        moment = robot.tool_rotation @ _moment(parameters) + parameters["mass"] * robot.tool
        mass = parameters["mass"]
        if mass:
            robot.bodies[5].append(Body(mass, moment / mass, np.zeros((3, 3))))
        else:
            _add_moment(robot, 5, 0.0, moment)

    def probes(self, joint, robot, scale):
        return [unit_probes(MOMENT, 10.0)]


class LinkMass(Effect):
    """Mass and first moment of the link that the joint moves, in its frame."""

    name = "link_mass"
    alters_model = True
    joints = ALL_JOINTS
    groups = ("xyz", "tau", "q_link")
    kinds = INERTIAL_KINDS
    hints = {"gravity": True}
    units = MOMENT_UNITS

    def draw(self, rng, joint, robot, scale):
        body = robot.bodies[joint - 1][0]
        mass = signed(rng, 0.08, 0.5) * body.mass
        moment = mass * body.com
        if rng.random() < 0.4:
            moment = moment + body.mass * rng.uniform(0.02, 0.15) * direction(rng)
        return {"mass": mass} | dict(zip(MOMENT[1:], moment.tolist()))

    def apply(self, machine, joint, parameters):
        mass, moment = parameters["mass"], _moment(parameters)
        body = machine.robot.bodies[joint - 1][0]
        at_com = mass * body.com
        if np.allclose(moment, at_com):  # the same body, heavier or lighter
            factor = 1 + mass / body.mass
            body.mass, body.inertia = body.mass * factor, body.inertia * factor
        else:
            _add_moment(machine.robot, joint - 1, mass, moment)

    def probes(self, joint, robot, scale):
        return [unit_probes(MOMENT, 10.0)]


class GravityCompensator(Effect):
    """A coil spring or gas balancer between links 1 and 2, which acts on joint 2: anchored a below the
    axis on link 1 and b on the tail of link 2 (below the axis too while the arm is up, q2 = −90°),
    pulling with preload + rate·(length − shortest)."""

    name = "gravity_compensator"
    joints = (2,)
    groups = ("xyz", "tau", "q_link")
    kinds = INERTIAL_KINDS
    hints = {"gravity": True}
    units = {"preload": "N", "rate": "N/m", "a": "m", "b": "m"}

    def draw(self, rng, joint, robot, scale):
        return {"preload": log_uniform(rng, 4e3, 3e4), "rate": log_uniform(rng, 5e3, 6e4),
                "a": float(rng.uniform(0.35, 0.6)), "b": float(rng.uniform(0.15, 0.3))}

    def apply(self, machine, joint, parameters):
        a, b = parameters["a"], parameters["b"]

        def torque(q):
            lean = q[:, 1] + 0.5 * np.pi
            length = np.sqrt(a * a + b * b - 2 * a * b * np.cos(lean))
            pull = parameters["preload"] + parameters["rate"] * (length - (a - b))
            out = np.zeros_like(q)
            out[:, 1] = -pull * a * b * np.sin(lean) / length
            return out

        machine.balance = torque

    def probes(self, joint, robot, scale):
        return [[{"preload": 1e4, "rate": 0.0, "a": 0.45, "b": 0.2},
                 {"preload": 1.0, "rate": 2e4, "a": 0.45, "b": 0.2}]]


EFFECTS = (Payload(), LinkMass(), GravityCompensator())
