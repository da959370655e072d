"""Motions as test engineers command them: circles, Fourier excitation, moves, poses."""

import numpy as np
from scipy.interpolate import CubicSpline, make_interp_spline

from .kinematics import jacobian, posture
from .motion import Track
from .robot import JOINTS

PLANES = {"xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
MARGIN = 0.03  # rad, kept from the joint limits


class Unreachable(Exception):
    """The motion does not fit into the robot's limits; another one should be drawn."""


def within_limits(robot, q):
    return bool(np.all(q > robot.lower + MARGIN) and np.all(q < robot.upper - MARGIN))


def working_posture(robot, rng):
    """Joint angles with the arm up, the forearm roughly level and the wrist bent."""
    q2 = rng.uniform(-1.9, -0.6)
    level = -q2 + rng.uniform(-0.5, 0.5)
    sign = rng.choice([-1, 1])
    return np.array([rng.uniform(-1.5, 1.5), q2, level, rng.uniform(-1.0, 1.0),
                     sign * rng.uniform(0.6, 1.4), rng.uniform(-1.5, 1.5)])


def inverse_kinematics(robot, start, position, orientation):
    """Joint angles (n, 6) of TCP positions (n, 3) at one orientation (3, 3), by Newton's method from
    start (6,)."""
    q = np.tile(start, (len(position), 1))
    for _ in range(30):
        place = posture(robot, q)
        turn = orientation @ np.swapaxes(place.tool_rotation, 1, 2)
        vee = 0.5 * np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0],
                              turn[:, 1, 0] - turn[:, 0, 1]], 1)
        error = np.concatenate([position - place.tcp, vee], 1)
        if np.abs(error).max() < 1e-11:
            break
        matrix = jacobian(place)
        if np.linalg.cond(matrix).max() > 1e4:
            raise Unreachable("near a singularity")
        q = q + np.clip(np.linalg.solve(matrix, error[..., None])[..., 0], -0.3, 0.3)
    else:
        raise Unreachable("inverse kinematics does not converge")
    if not within_limits(robot, q):
        raise Unreachable("joint limits")
    return q


def circle(robot, rng, rate, duration, radius, plane, laps, clockwise):
    """The TCP runs `laps` times round a circle about a drawn point, orientation kept."""
    q0 = working_posture(robot, rng)
    start = posture(robot, q0[None])
    first, second = PLANES[plane]
    angle = np.linspace(0, 2 * np.pi, 361)
    points = np.tile(start.tcp[0], (len(angle), 1))
    points[:, first] += radius * np.cos(angle)
    points[:, second] += radius * np.sin(angle)
    q = inverse_kinematics(robot, q0, points, start.tool_rotation[0])
    q[-1] = q[0]
    spline = CubicSpline(angle, q, bc_type="periodic")
    time = np.arange(0, duration, 1 / rate)
    speed = (-1 if clockwise else 1) * 2 * np.pi * laps / duration
    phase = rng.uniform(0, 2 * np.pi) + speed * time
    track = Track(time, spline(phase), spline(phase, 1) * speed, spline(phase, 2) * speed**2)
    return track, phase


def fourier(robot, rng, rate, duration, base, reach, centre=None, harmonics=5):
    """All joints swing as Fourier series of base frequency `base` Hz; the fastest joint comes to
    `reach` of its speed limit. The swing is bounded by the joint limits."""
    centre = working_posture(robot, rng) if centre is None else centre
    time = np.arange(0, duration, 1 / rate)
    omega = 2 * np.pi * base * np.arange(1, harmonics + 1)
    weight = rng.normal(size=(2, harmonics, JOINTS)) / np.sqrt(np.arange(1, harmonics + 1))[:, None]
    wave = np.outer(time, omega)
    sine, cosine = np.sin(wave), np.cos(wave)
    swing = sine @ (weight[0] / omega[:, None]) - cosine @ (weight[1] / omega[:, None])
    velocity = cosine @ weight[0] + sine @ weight[1]
    acceleration = -sine @ (weight[0] * omega[:, None]) + cosine @ (weight[1] * omega[:, None])
    room = np.minimum(robot.upper - centre, centre - robot.lower) - MARGIN
    room = np.minimum(room, 1.5)
    share = np.minimum(reach * robot.speed / np.abs(velocity).max(0), room / np.abs(swing).max(0))
    return Track(time, centre + share * swing, share * velocity, share * acceleration)


def _pulse(time, begin, length):
    """A smooth change of speed by one, from begin on, over length: position, velocity, acceleration."""
    share = np.clip((time - begin) / length, 0, 1)
    wave = 2 * np.pi * share
    position = length * (share**2 / 2 + (np.cos(wave) - 1) / (4 * np.pi**2))
    position += np.maximum(time - begin - length, 0)
    return np.stack([position, share - np.sin(wave) / (2 * np.pi), (1 - np.cos(wave)) / length])


def moves(robot, rng, rate, duration, reach, centre=None):
    """Moves between drawn postures with stops between, as a robot program makes them; the
    acceleration rises and falls within 0.1 to 0.25 s."""
    centre = working_posture(robot, rng) if centre is None else centre
    time = np.arange(0, duration, 1 / rate)
    motion = np.zeros((3, len(time), JOINTS))
    goal, begin = centre, 0.3
    while begin < duration - 1.0:
        target = np.clip(centre + rng.uniform(-0.35, 0.35, JOINTS), robot.lower + 0.1,
                         robot.upper - 0.1)
        ramp = rng.uniform(0.1, 0.25)
        length = max(np.max(np.abs(target - goal) / (reach * robot.speed)), ramp)
        profile = (_pulse(time, begin, ramp) - _pulse(time, begin + length, ramp)) / length
        motion += profile[:, :, None] * (target - goal)
        begin += length + ramp + rng.uniform(0.2, 0.8)
        goal = target
    return Track(time, centre + motion[0], motion[1], motion[2])


def poses(robot, rng, count, rows_each):
    """`count` working postures, each held for rows_each rows; time counts rows."""
    chosen = np.array([working_posture(robot, rng) for _ in range(count)])
    if not within_limits(robot, chosen):
        raise Unreachable("joint limits")
    q = np.repeat(chosen, rows_each, 0)
    return Track(np.arange(len(q), dtype=float), q, 0 * q, 0 * q)


def smooth(rng, time, knots, low, high):
    """A smooth course between drawn values in [low, high] (n,)."""
    at = np.linspace(time[0], time[-1], knots)
    return make_interp_spline(at, rng.uniform(low, high, knots), k=3)(time)
