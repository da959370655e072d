"""Physics that no catalogue of robots' defects holds."""

import numpy as np

from ..assembly import HINGE, stiff_friction
from .base import Effect

SMOOTH_SPEED = 3e-3  # rad/s over which friction turns round


def _burst(rng, time, count, length):
    """Smooth bumps of height one at drawn moments (n,); length: s, least and most."""
    course = np.zeros(len(time))
    for _ in range(count):
        begin, last = rng.uniform(time[0], time[-1] - length[1]), rng.uniform(*length)
        course += np.sin(np.pi * np.clip((time - begin) / last, 0, 1)) ** 2
    return course


class DressPack(Effect):
    """A hose from link 3, before joint 4, to the flange that pulls once it is taut, and rubs in its
    guide.

    stiffness: N/m, slack: m of length before it is taut, friction: N."""

    name = "dress_pack"

    def build(self, assembly):
        joints = assembly.description.joints
        arm = joints[2]
        aside = np.array([0.0, 0.25, 0.1])
        assembly.links[2].add_site(name="hose_arm", pos=arm.body.center + aside)
        assembly.tool.add_site(name="hose_flange", pos=[0.12, 0.05, -0.1])
        hose = assembly.spec.add_tendon(
            name="hose", stiffness=[self.parameters["stiffness"], 0, 0],
            springlength=[0, self.parameters["slack"]],
            **stiff_friction(self.parameters["friction"]))
        hose.wrap_site("hose_arm")
        hose.wrap_site("hose_flange")


class LoosePayload(Effect):
    """The load of the robot hangs in a worn hinge and rattles between stops `play` (rad) apart."""

    name = "loose_payload"

    def build(self, assembly):
        half = 0.5 * self.parameters["play"]
        payload = assembly.spec.body("payload")
        payload.inertia = [0.02 * payload.mass] * 3
        payload.add_joint(name="loose", type=HINGE, axis=[1, 0, 0], pos=[0, 0, -0.12],
                          range=[-half, half], limited=True, armature=0.1, damping=[2.0, 0, 0],
                          solref_limit=[4e-3, 0.3])


class WristCoupling(Effect):
    """The wrist's gears are not decoupled: motor 5 turns link 6 along by `ratio`."""

    name = "wrist_coupling"

    def prepare(self, simulation):
        self._spring = simulation.qpos("spring_6")
        self._motor = simulation.motor[4]
        self._start = simulation.posture[4]

    def step(self, simulation, row):
        turned = simulation.data.qpos[self._motor] - self._start
        simulation.model.qpos_spring[self._spring] = self.parameters["ratio"] * turned


class FloorVibration(Effect):
    """A neighbouring machine shakes the floor now and then: `amplitude` (m), `frequency` (Hz)."""

    name = "floor_vibration"

    def begin(self, rng, course):
        wave = np.sin(2 * np.pi * self.parameters["frequency"] * course.time + rng.uniform(0, 6))
        direction = rng.normal(size=3)
        shake = _burst(rng, course.time, 6, (1.0, 3.0)) * wave * self.parameters["amplitude"]
        self._course = np.outer(shake, direction / np.linalg.norm(direction))
        return course

    def step(self, simulation, row):
        if row is not None:
            simulation.model.body("base").pos[:] = self._course[row]


class TrackerJump(Effect):
    """The air between tracker and target changes at one moment: readings jump by `size` (m)."""

    name = "tracker_jump"

    def begin(self, rng, course):
        rows = len(course.temperature)
        direction = rng.normal(size=3)
        moment = int(rows * rng.uniform(0.35, 0.7))
        jump = self.parameters["size"] * direction / np.linalg.norm(direction)
        self._course = np.outer(np.arange(rows) >= moment, jump)
        return course

    def sense(self, signals, description):
        signals.xyz = signals.xyz + self._course


class CuttingFluid(Effect):
    """A jet hits the wrist now and then with `force` (N), behind the force sensor."""

    name = "cutting_fluid"

    def begin(self, rng, course):
        direction = rng.normal(size=3)
        push = _burst(rng, course.time, 8, (0.6, 2.0)) * self.parameters["force"]
        self._course = np.outer(push, direction / np.linalg.norm(direction))
        return course

    def prepare(self, simulation):
        self._body = simulation.model.body("link_5").id

    def step(self, simulation, row):
        force = 0 if row is None else self._course[row]
        simulation.data.xfrc_applied[self._body, :3] = force


class TorqueLimit(Effect):
    """The current sensor of a joint reads `limit` (N·m) at most, either way."""

    name = "torque_limit"

    def sense(self, signals, description):
        column = signals.tau[:, self.joint - 1]
        np.clip(column, -self.parameters["limit"], self.parameters["limit"], out=column)


class LoadFriction(Effect):
    """Friction of the gear that grows with what it carries: `share` of the spring's torque."""

    name = "load_friction"

    def prepare(self, simulation):
        self._dof = simulation.motor_dof[self.joint - 1]
        joint = simulation.model.joint(f"spring_{self.joint}")
        self._spring, self._stiffness = simulation.qpos(joint.name), joint.stiffness[0]

    def step(self, simulation, row):
        load = self._stiffness * simulation.data.qpos[self._spring]
        turn = np.tanh(simulation.data.qvel[self._dof] / SMOOTH_SPEED)
        simulation.data.qfrc_applied[self._dof] -= self.parameters["share"] * abs(load) * turn
