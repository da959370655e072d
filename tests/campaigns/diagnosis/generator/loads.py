"""Wrenches on the tool: milling, loads hung or pushed on in a static test, a slow push."""

import numpy as np

from .trajectories import PLANES, smooth


def rumble(rng, time, top):
    """Twelve sinusoids of drawn frequency between 1 Hz and top Hz, unit rms (n,)."""
    frequency = rng.uniform(1.0, top, 12)
    phase = rng.uniform(0, 2 * np.pi, 12)
    return np.sin(2 * np.pi * np.outer(time, frequency) + phase).sum(1) / np.sqrt(6)


def milling(rng, time, phase, plane, force, top=35.0):
    """Cutting wrench (n, 6), base frame: turns with the path, follows a changing depth of cut, and
    rumbles. force: N, of the whole vector in the mean."""
    depth = np.clip(smooth(rng, time, rng.integers(6, 14), 0.2, 1.4), 0.1, None)
    radial, feed, axial = np.array([0.28, 0.87, 0.40]) * rng.uniform(0.7, 1.3, 3)
    turning = phase + rng.uniform(-0.5, 0.5)
    wrench = np.zeros((len(time), 6))
    first, second = PLANES[plane]
    third = 3 - first - second
    size = [force * depth * (1 + rng.uniform(0.05, 0.12) * rumble(rng, time, top)) for _ in range(3)]
    wrench[:, first] = size[0] * radial * np.cos(turning) - size[1] * feed * np.sin(turning)
    wrench[:, second] = size[0] * radial * np.sin(turning) + size[1] * feed * np.cos(turning)
    wrench[:, third] = size[2] * axial * (1 if rng.random() < 0.5 else -1)
    wrench[:, 3 + third] = force * depth * rng.uniform(0.003, 0.02)
    wrench[:, 3 + first] = force * depth * rng.uniform(-0.005, 0.005)
    return wrench


def pushing(rng, time, force, top=12.0):
    """A force (n, 6) whose direction and size wander and change sign: a robot grinding over a part."""
    knots = max(8, int((time[-1] - time[0]) / 3))
    wrench = np.zeros((len(time), 6))
    for k in range(3):
        wrench[:, k] = force * smooth(rng, time, knots, -1, 1)
        wrench[:, k] += 0.05 * force * rumble(rng, time, top)
        wrench[:, 3 + k] = 0.05 * force * smooth(rng, time, knots, -1, 1)
    return wrench


def load_steps(rng, count, steps, force):
    """Static loads (count·len, 6): at each pose a direction is loaded up, off, against and off again.
    steps: loads in one half-loop."""
    up = np.linspace(0, 1, steps + 1)
    loop = np.concatenate([up, up[-2::-1], -up[1:], -up[-2::-1]])
    blocks = []
    for _ in range(count):
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        block = np.zeros((len(loop), 6))
        block[:, :3] = np.outer(loop * force * rng.uniform(0.6, 1.0), direction)
        block[:, 3:] = np.outer(loop, rng.normal(size=3) * 0.04 * force)
        blocks.append(block)
    return np.concatenate(blocks)
