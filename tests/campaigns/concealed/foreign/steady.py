"""A machine whose servos follow exactly and whose springs are always at rest under what they carry.

Kinematics and inverse dynamics are MuJoCo's. Of the catalogue's effects it takes those that change
numbers of the robot or what a sensor sees.
"""

import copy

import mujoco
import numpy as np
from scipy.interpolate import CubicSpline

from plant import assembly
from plant.motion import Signals

from .law import Foreign, Seen

COARSE = 4e-3  # s between rows that the engine sees
SETTLING = 3  # rounds until springs and weights agree
SMOOTH_SPEED = 3e-4  # rad/s over which dry friction turns round


class Arm:
    """The rigid robot."""

    def __init__(self, description):
        self._model = assembly.rigid(description)
        self._data = mujoco.MjData(self._model)
        self._site = self._model.site("tcp").id

    def at(self, q, velocity, acceleration, wrench):
        """Of rows (n, 6): load (n, 6) N·m of weight, inertia and wrench on the joints; TCP (n, 3);
        tool frame (n, 3, 3)."""
        model, data = self._model, self._data
        moves, turns = np.empty((3, 6)), np.empty((3, 6))
        load, place, tool = np.empty_like(q), np.empty((len(q), 3)), np.empty((len(q), 9))
        for row in range(len(q)):
            data.qpos[:], data.qvel[:] = q[row], velocity[row]
            data.qacc[:] = acceleration[row]
            mujoco.mj_inverse(model, data)
            mujoco.mj_jacSite(model, data, moves, turns, self._site)
            load[row] = (moves.T @ wrench[row, :3] + turns.T @ wrench[row, 3:]
                         - data.qfrc_inverse)
            place[row], tool[row] = data.site_xpos[self._site], data.site_xmat[self._site]
        return load, place, tool.reshape(-1, 3, 3)


def _rows(course):
    """(Seen without loads, wrench) at the rows that the engine sees."""
    if hasattr(course, "velocity"):
        stride = max(1, round(COARSE / course.step))
        rows = np.unique(np.append(np.arange(0, len(course.time), stride), len(course.time) - 1))
        return Seen(course.time[rows], course.q[rows], course.velocity[rows],
                    course.acceleration[rows], None), course.wrench[rows]
    q = np.repeat(course.q, course.wrench.shape[1], 0)
    still = np.zeros_like(q)
    return (Seen(np.arange(len(q), dtype=float), q, still, still, None),
            course.wrench.reshape(-1, 6))


def _stands(description, effects, seen, wrench):
    """(q_link (n, 6), TCP (n, 3), tool frame (n, 3, 3)); sets the loads of `seen`."""
    arm, compliance = Arm(description), description.column("compliance")
    link = seen.q
    for _ in range(SETTLING):
        seen.load = arm.at(link, seen.v, seen.a, wrench)[0]
        link = seen.q + compliance * seen.load
    link = link.copy()
    for effect in effects:
        if effect.joint:
            link[:, effect.joint - 1] += effect.angle(seen)
    _, place, tool = arm.at(link, seen.v, seen.a, wrench)
    for effect in effects:
        place = effect.moved(seen, place)
    return link, place, tool


def _torques(description, effects, seen):
    """(n, 6) N·m of the drives."""
    torque = (description.column("rotor_inertia") * seen.a + description.column("viscous") * seen.v
              + description.column("coulomb") * np.tanh(seen.v / SMOOTH_SPEED) - seen.load)
    for effect in effects:
        if effect.joint:
            torque[:, effect.joint - 1] += effect.extra(seen)
    return torque


def simulate(description, effects, course, rng):
    """Signals of a robot with effects in a Motion or a LoadTest, those at the sensors included. rng:
    of what effects do anew in every recording."""
    for effect in effects:
        course = effect.begin(rng, course)
    actual = copy.deepcopy(description)
    for effect in effects:
        effect.alter(actual)
    foreign = [effect for effect in effects if isinstance(effect, Foreign)]
    seen, wrench = _rows(course)
    link, place, tool = _stands(actual, foreign, seen, wrench)
    is_motion = hasattr(course, "velocity")
    if is_motion:
        dense = Seen(course.time, course.q, course.velocity, course.acceleration, None)
        link, place, tool, dense.load = (
            CubicSpline(seen.time, values)(course.time)
            for values in (link, place, tool, seen.load))
        seen, wrench = dense, course.wrench
    torque = _torques(actual, foreign, seen)
    signals = Signals(seen.time, seen.q, seen.q.copy(), link, torque, wrench.copy(), place, tool,
                      course.temperature, static=not is_motion)
    for effect in effects:
        effect.sense(signals, description)
    return signals
