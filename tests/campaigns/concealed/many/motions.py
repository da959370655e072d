"""Poses and motions within a region of the joint space."""

import dataclasses

import numpy as np

from . import robots

WAVES = 7  # that a joint's motion is the sum of
WIDEST = np.array([1.0, 0.6, 0.7, 1.2, 1.0, 1.5])  # rad either way
LULL = 0.5  # s of rest before the first start and after the last stop


@dataclasses.dataclass(frozen=True)
class Region:
    """A box of joint angles, rad (6,)."""

    center: np.ndarray
    half: np.ndarray

    def draw(self, rng, count):
        """(count, 6), even all over."""
        return self.center + self.half * rng.uniform(-1, 1, (count, 6))


def regions(rng, description):
    """(where it is trained, where it is not)."""
    lower, upper = robots.workable(description)
    half = np.minimum(WIDEST * rng.uniform(0.7, 1.0), 0.3 * (upper - lower))
    free = (upper - lower) / 2 - half
    middle = (lower + upper) / 2
    center = middle + free * rng.uniform(-0.7, 0.7, 6)
    # The first three joints work elsewhere, on the side with more room.
    away = np.where(center > middle, -1, 1) * half * rng.uniform(1.2, 1.6, 6)
    away[3:] *= 0.5
    other = np.clip(center + away, lower + half, upper - half)
    return Region(center, half), Region(other, half)


@dataclasses.dataclass(frozen=True)
class Course:
    """A motion: time (n,), q, velocity, acceleration (n, 6)."""

    time: np.ndarray
    q: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


def _step(time, begin, within):
    """From 0 to 1: value, slope."""
    s = np.clip((time - begin) / within, 0, 1)
    return s**3 * (10 - 15 * s + 6 * s**2), 30 * s**2 * (1 - s) ** 2 / within


def pace(time, rests, within):
    """How fast the course is run through: from 0 over 1 to 0, with other paces (begin, end, pace) on
    the way, changed within so many s. Returns course time, pace, change of pace (n,)."""
    up, slope_up = _step(time, time[0] + LULL, within)
    down, slope_down = _step(time, time[-1] - LULL - within, within)
    rate, change = up - down, slope_up - slope_down
    for begin, end, slow in rests:
        one, slope = _step(time, begin, within)
        two, back = _step(time, end, within)
        rate = rate - (1 - slow) * (one - two)
        change = change - (1 - slow) * (slope - back)
    step = time[1] - time[0]
    return np.concatenate([[0], np.cumsum((rate[1:] + rate[:-1]) / 2)]) * step, rate, change


def swing(rng, description, region, duration, step, *, top, share, within, rests=()):
    """A Course: every joint a sum of sinusoids of up to top (Hz) that fills its region or comes to a
    share of its speed limit."""
    time = np.arange(0, duration, step)
    along, rate, change = pace(time, rests, within)
    omega = 2 * np.pi * top * rng.uniform(0.1, 1, (WAVES, 1, 6))
    weight = rng.normal(size=(WAVES, 1, 6)) / np.sqrt(omega)
    wave = omega * along[:, None] + rng.uniform(0, 2 * np.pi, (WAVES, 1, 6))
    q = (weight * np.sin(wave)).sum(0)
    first = (weight * omega * np.cos(wave)).sum(0)
    second = -(weight * omega**2 * np.sin(wave)).sum(0)
    middle = (q.max(0) + q.min(0)) / 2
    size = np.minimum(region.half / (np.ptp(q, axis=0) / 2),
                      share * description.column("speed") / np.abs(first).max(0))
    rate, change = rate[:, None], change[:, None]
    return Course(time, region.center + size * (q - middle), size * first * rate,
                  size * (second * rate**2 + first * change))
