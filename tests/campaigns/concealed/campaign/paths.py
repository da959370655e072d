"""Motions that a careful test engineer chooses: slow circles, smooth swings of all joints."""

import mujoco
import numpy as np
from scipy.interpolate import CubicSpline

from plant import assembly

PLANES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
MARGIN = 0.05  # rad from the joint limits
WORST_CONDITION = 40.0  # of the Jacobian, lengths in m


class Unreachable(Exception):
    """The motion does not fit into the robot's limits; another one should be drawn."""


class Arm:
    """Kinematics of the rigid robot by the engine."""

    def __init__(self, description):
        self._model = assembly.rigid(description)
        self._data = mujoco.MjData(self._model)
        self._site = self._model.site("tcp").id
        self.lower, self.upper = description.column("lower"), description.column("upper")

    def place(self, q):
        """Position (3,) and rotation (3, 3) of the tool frame."""
        self._data.qpos[:] = q
        mujoco.mj_kinematics(self._model, self._data)
        return (self._data.site_xpos[self._site].copy(),
                self._data.site_xmat[self._site].reshape(3, 3).copy())

    def jacobian(self, q):
        """(6, 6): velocity, then spin, of the tool frame by the joint speeds."""
        self._data.qpos[:] = q
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        linear, angular = np.zeros((3, 6)), np.zeros((3, 6))
        mujoco.mj_jacSite(self._model, self._data, linear, angular, self._site)
        return np.concatenate([linear, angular])

    def check(self, q):
        """Raises Unreachable where rows of q (n, 6) come near a limit."""
        if np.any(q < self.lower + MARGIN) or np.any(q > self.upper - MARGIN):
            raise Unreachable("joint limits")

    def follow(self, start, points, rotation):
        """Joint angles (n, 6) that hold a rotation at points (n, 3), by Newton's method."""
        q, found = start.copy(), []
        for point in points:
            for _ in range(20):
                position, turn = self.place(q)
                twist = turn.T @ rotation
                vee = [twist[2, 1] - twist[1, 2], twist[0, 2] - twist[2, 0],
                       twist[1, 0] - twist[0, 1]]
                error = np.concatenate([point - position, 0.5 * turn @ vee])
                if np.abs(error).max() < 1e-11:
                    break
                jacobian = self.jacobian(q)
                if np.linalg.cond(jacobian) > WORST_CONDITION:
                    raise Unreachable("near a singularity")
                q = q + np.clip(np.linalg.solve(jacobian, error), -0.2, 0.2)
            else:
                raise Unreachable("inverse kinematics does not converge")
            found.append(q)
        found = np.array(found)
        self.check(found)
        return found


def posture(rng):
    """Arm up, forearm roughly level, wrist bent (6,)."""
    lean = rng.uniform(-1.7, -0.8)
    return np.array([rng.uniform(-0.8, 0.8), lean, -lean + rng.uniform(-0.3, 0.5),
                     rng.uniform(-0.8, 0.8), rng.choice([-1, 1]) * rng.uniform(0.7, 1.3),
                     rng.uniform(-1.5, 1.5)])


def nearby(rng, center):
    """Another posture in the same region of the workspace."""
    return center + rng.uniform(-1, 1, 6) * np.array([0.15, 0.08, 0.1, 0.15, 0.12, 0.2])


def far_from(rng, center):
    """A posture in another sector, at another height and reach."""
    shift = np.array([rng.uniform(0.9, 1.5), rng.uniform(0.2, 0.4), rng.uniform(0.2, 0.45),
                      rng.uniform(0.3, 0.7), rng.uniform(0.15, 0.3), rng.uniform(0.5, 1.0)])
    sign = rng.choice([-1, 1], 6)
    sign[1] = 1 if center[1] < -1.25 else -1
    sign[2] = -sign[1]
    return center + sign * shift


BLEND = np.polynomial.Polynomial([0, 0, 0, 0, 0, 126, -420, 540, -315, 70])


def blend(time, begin, length):
    """A step from 0 to 1, its first and its second derivative (3, n). Jerk and snap begin and end at
    zero, or the arm would ring for seconds."""
    s = np.clip((time - begin) / length, 0, 1)
    return np.stack([BLEND(s), BLEND.deriv(1)(s) / length, BLEND.deriv(2)(s) / length**2])


def circle(arm, center, time, ramp, radius, plane, feed, sense, phase):
    """The TCP runs round a circle from rest, up to the feed (m/s) within ramp (s), without turning.
    Returns q, velocity, acceleration (n, 6) and the angle on the circle (n,)."""
    middle, rotation = arm.place(center)
    first, second = PLANES[plane]
    angle = np.linspace(0, 2 * np.pi, 181)
    points = np.tile(middle, (len(angle), 1))
    points[:, first] += radius * np.cos(angle)
    points[:, second] += radius * np.sin(angle)
    start = arm.follow(center, np.linspace(middle, points[0], 6), rotation)[-1]
    q = arm.follow(start, points, rotation)
    if np.abs(q[-1] - q[0]).max() > 1e-6:
        raise Unreachable("another branch of the inverse kinematics")
    q[-1] = q[0]
    spline = CubicSpline(angle, q, bc_type="periodic")
    step = time[1] - time[0]
    rate = sense * feed / radius
    speed, push = rate * blend(time, time[0], ramp)[:2]
    turned = phase + np.cumsum(speed) * step
    velocity = spline(turned, 1) * speed[:, None]
    acceleration = spline(turned, 2) * (speed**2)[:, None] + spline(turned, 1) * push[:, None]
    return spline(turned), velocity, acceleration, turned


def swing(rng, arm, description, center, time, ramp, base, harmonics, share, widest):
    """All joints swing as sums of sinusoids, multiples of base (Hz), from rest within ramp (s).
    Each comes to its share (6,) of its speed limit or swings by widest (6,) in rad. Returns q,
    velocity, acceleration (n, 6)."""
    weight = rng.normal(size=(harmonics, 6)) / np.sqrt(np.arange(1, harmonics + 1))[:, None]
    phase = rng.uniform(0, 2 * np.pi, (harmonics, 6))
    omega = 2 * np.pi * base * np.arange(1, harmonics + 1)[:, None, None]
    wave = omega * time[:, None] + phase[:, None]
    size = weight[:, None] / omega
    motion = np.stack([(size * np.sin(wave)).sum(0), (size * omega * np.cos(wave)).sum(0),
                       -(size * omega**2 * np.sin(wave)).sum(0)])
    limit = np.minimum(share * description.column("speed") / np.abs(motion[1]).max(0),
                       widest / np.abs(motion[0]).max(0))
    motion *= limit
    grow = blend(time, time[0], ramp)[:, :, None]
    q = center + grow[0] * motion[0]
    arm.check(q)
    return (q, grow[0] * motion[1] + grow[1] * motion[0],
            grow[0] * motion[2] + 2 * grow[1] * motion[1] + grow[2] * motion[0])
