"""Runs the plant: a motion in time, or loads that settle one after another."""

import copy

import mujoco
import numpy as np

from . import assembly as assemblies
from .motion import Signals
from .servo import Servo

# An unstable plant raises; the engine would say it in a log in the user's folder, too.
mujoco.set_mju_user_warning(lambda words: None)

CLAMPED = 1e9  # kg·m²: a rotor that nothing moves
RELAXING = 1.0  # of critical: damping while loads settle
SETTLE = 0.6  # s, for a first equilibrium
LOAD_RAMP, LOAD_HOLD = 0.25, 0.25  # s
AT_REST = 1e-6  # rad/s, m/s
LONGEST_HOLD = 1.0  # s more, until it is at rest; what chatters between stops may never be


class Simulation:
    """The compiled plant with its effects.

    Effects read and write `model` and `data`, and add generalised forces to `data.qfrc_applied`,
    which is cleared before each step.
    """

    def __init__(self, description, effects, posture, step=None):
        self.nominal, self.posture = description, posture
        self.effects = effects
        self.description = copy.deepcopy(description)
        for effect in effects:
            effect.alter(self.description)
        self.assembly = assemblies.flexible(self.description)
        if step:
            self.assembly.spec.option.timestep = step
        for effect in effects:
            effect.build(self.assembly)
        self.model = assemblies.compile_with_damping(self.assembly, posture)
        self.data = mujoco.MjData(self.model)
        self.motor_dof = self.dofs("motor")
        self.motor = np.array([self.qpos(f"motor_{k}") for k in range(1, 7)])
        self.turning = np.zeros((6, self.model.nq))
        for joint in range(6):
            for name in self.assembly.turning[joint]:
                self.turning[joint, self.qpos(name)] = 1
        self.site = self.model.site("tcp").id
        self.step = self.model.opt.timestep
        self.motion = self.servo = None

    def qpos(self, name):
        """Index of a joint in qpos."""
        return int(self.model.joint(name).qposadr[0])

    def dof(self, name):
        return int(self.model.joint(name).dofadr[0])

    def dofs(self, kind):
        """Indices (6,) in qvel of "motor" or "spring"."""
        return np.array([self.dof(f"{kind}_{k}") for k in range(1, 7)])

    def _relax(self, posture, wrench_course):
        """Holds the motors at a posture under wrenches, and then until the rest, heavily damped,
        has settled."""
        model, data = self.model, self.data
        saved = model.dof_armature.copy(), model.dof_damping.copy()
        model.dof_armature[self.motor_dof] = CLAMPED
        sprung = (model.jnt_stiffness > 0).nonzero()[0]
        full = np.zeros((model.nv, model.nv))
        data.qpos[self.motor] = posture
        data.qvel[:] = 0
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, full)
        for joint in sprung:
            dof = model.jnt_dofadr[joint]
            critical = 2 * np.sqrt(model.jnt_stiffness[joint] * full[dof, dof])
            model.dof_damping[dof] = RELAXING * critical
        data.ctrl[:6] = 0
        for wrench in wrench_course:
            data.ctrl[6:12] = wrench
            self._advance_held()
        for _ in range(round(LONGEST_HOLD / self.step)):
            if np.abs(data.qvel).max() < AT_REST:
                break
            self._advance_held()
        model.dof_armature[:], model.dof_damping[:] = saved
        data.qvel[:] = 0
        mujoco.mj_forward(model, data)

    def _advance_held(self):
        """A step in which the motors, heavy as they are, do not gather speed under a load."""
        self._advance(None)
        self.data.qvel[self.motor_dof] = 0

    def _advance(self, row, log=None):
        model, data = self.model, self.data
        mujoco.mj_step1(model, data)
        data.qfrc_applied[:] = 0
        if self.servo is not None and row is not None:
            data.ctrl[:6] = self.servo.torque(row, data.qpos[self.motor], data.qvel[self.motor_dof])
            data.ctrl[6:12] = self.motion.wrench[row]
        for effect in self.effects:
            effect.step(self, row)
        if log is not None:
            log(row)
        mujoco.mj_step2(model, data)

    def run(self, motion):
        """Signals of a motion, whose grid of time is the engine's."""
        self.motion = motion
        for effect in self.effects:
            effect.prepare(self)
        self._relax(motion.q[0], np.repeat(motion.wrench[:1], round(SETTLE / self.step), 0))
        self.servo = Servo(self.nominal, motion)
        for effect in self.effects:
            effect.prepare_servo(self.servo)
        n, model, data = len(motion.time), self.model, self.data
        qpos, tau = np.empty((n, model.nq)), np.empty((n, 6))
        xyz, tool = np.empty((n, 3)), np.empty((n, 9))

        def log(row):
            qpos[row], tau[row] = data.qpos, data.ctrl[:6]
            xyz[row], tool[row] = data.site_xpos[self.site], data.site_xmat[self.site]

        for row in range(n):
            self._advance(row, log)
        if not np.isfinite(qpos).all():
            raise FloatingPointError("the plant is unstable")
        return Signals(motion.time, motion.q, qpos[:, self.motor], qpos @ self.turning.T, tau,
                       motion.wrench, xyz, tool.reshape(n, 3, 3), motion.temperature)

    def settle(self, test):
        """Signals of a load test, a row a settled load."""
        for effect in self.effects:
            effect.prepare(self)
        model, data = self.model, self.data
        poses, loads, _ = test.wrench.shape
        ramp = 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, round(LOAD_RAMP / self.step)))[:, None]
        ramp = np.concatenate([ramp, np.ones((round(LOAD_HOLD / self.step), 1))])
        rows = {"q_link": [], "xyz": [], "tool": []}
        for pose in range(poses):
            before = np.zeros(6)
            self._relax(test.q[pose], np.zeros((round(SETTLE / self.step), 6)))
            for load in range(loads):
                wrench = test.wrench[pose, load]
                self._relax(test.q[pose], before + ramp * (wrench - before))
                before = wrench
                rows["q_link"].append(self.turning @ data.qpos)
                rows["xyz"].append(data.site_xpos[self.site].copy())
                rows["tool"].append(data.site_xmat[self.site].reshape(3, 3).copy())
        q = np.repeat(test.q, loads, 0)
        n = len(q)
        return Signals(np.arange(n, dtype=float), q, q.copy(), np.array(rows["q_link"]),
                       np.zeros((n, 6)), test.wrench.reshape(n, 6), np.array(rows["xyz"]),
                       np.array(rows["tool"]), test.temperature, static=True)


def simulate(description, effects, course, rng=None):
    """Signals of a robot with effects in a Motion or a LoadTest, effects at the sensors included.
    rng: of what effects do anew in every recording."""
    rng = rng or np.random.default_rng(0)
    for effect in effects:
        course = effect.begin(rng, course)
    simulation = Simulation(description, effects, course.q[0])
    is_motion = hasattr(course, "velocity")
    signals = (simulation.run(course) if is_motion else simulation.settle(course)).copy()
    for effect in effects:
        effect.sense(signals, description)
    return signals
