"""Forces of the process on the tool, and loads of a static test."""

import numpy as np
from scipy.interpolate import make_interp_spline

from .paths import PLANES, blend


def slow_course(rng, time, spacing, low, high):
    """A smooth course through values drawn from [low, high], one each `spacing` s (n,)."""
    count = max(5, int((time[-1] - time[0]) / spacing))
    knots = np.linspace(time[0], time[-1], count)
    return make_interp_spline(knots, rng.uniform(low, high, count), k=3)(time)


def milling(rng, time, ramp, angle, plane, sense, force):
    """Wrench (n, 6), base frame: a mean cutting force that turns with the feed, changes slowly with
    the depth of cut, and ripples a little at the tooth passing frequency.

    force: N in the mean. angle: (n,) rad on a circle in the plane."""
    depth = np.clip(slow_course(rng, time, 3.5, 0.3, 1.5), 0.15, None)
    tooth = 2 * np.pi * rng.uniform(130, 180)  # rad/s, above what the arm answers to
    depth = depth * (1 + 0.004 * np.sin(tooth * time)) * blend(time, time[0], ramp)[0]
    radial, feed, axial = np.array([0.4, 0.85, 0.35]) * rng.uniform(0.8, 1.2, 3)
    first, second = PLANES[plane]
    third = 3 - first - second
    wrench = np.zeros((len(time), 6))
    outward = np.stack([np.cos(angle), np.sin(angle)], 1)
    ahead = sense * np.stack([-np.sin(angle), np.cos(angle)], 1)
    push = force * depth[:, None] * (radial * outward - feed * ahead)
    wrench[:, first], wrench[:, second] = push.T
    wrench[:, third] = force * axial * rng.choice([-1, 1]) * depth
    wrench[:, 3 + third] = 0.012 * force * depth  # N·m: the torque of the spindle
    return wrench


def pushing(rng, time, ramp, force):
    """A wrench (n, 6) that wanders slowly in direction and size: grinding over a part."""
    wrench = np.stack([slow_course(rng, time, 3.5, -1, 1) for _ in range(6)], 1)
    size = np.array([force] * 3 + [0.05 * force] * 3)
    return wrench * size * blend(time, time[0], ramp)[0][:, None]


def load_loops(rng, poses, steps, force):
    """Loads (poses, loads, 6): in each pose one direction is loaded up, off, against and off, twice
    over with two directions. steps: loads from nothing to the top."""
    up = np.linspace(0, 1, steps + 1)
    loop = np.concatenate([up, up[-2::-1], -up[1:], -up[-2::-1]])
    loads = np.zeros((poses, 2 * len(loop), 6))
    for pose in range(poses):
        for half in range(2):
            direction = rng.normal(size=3)
            direction *= force * rng.uniform(0.6, 1.0) / np.linalg.norm(direction)
            moment = rng.normal(size=3) * 0.03 * force
            rows = slice(half * len(loop), (half + 1) * len(loop))
            loads[pose, rows] = np.outer(loop, np.concatenate([direction, moment]))
    return loads
