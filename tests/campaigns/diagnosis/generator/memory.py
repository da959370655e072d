"""Physics that remembers: lag, play, hysteresis, a vibrating mode. Column by column along time."""

import dataclasses
import math

import numpy as np
from scipy import signal


def first_order_lag(track, lag):
    """The motion that follows `track` with time constants lag (6,) s; starts having caught up."""
    q, velocity, acceleration = (np.array(part) for part in
                                 (track.q, track.velocity, track.acceleration))
    for k in np.flatnonzero(lag):
        system = signal.cont2discrete(([1.0], [lag[k], 1.0]), track.step, method="foh")
        top, bottom = system[0].ravel(), system[1]
        begin = track.q[0, k]
        forced = signal.lfilter(top, bottom, track.q[:, k] - begin)
        behind = lag[k] * track.velocity[0, k]  # what a long ramp before the start leaves
        late = begin + forced - behind * np.exp(-(track.time - track.time[0]) / lag[k])
        q[:, k] = late
        velocity[:, k] = (track.q[:, k] - late) / lag[k]
        acceleration[:, k] = (track.velocity[:, k] - velocity[:, k]) / lag[k]
    return dataclasses.replace(track, q=q, velocity=velocity, acceleration=acceleration)


def motion_play(x, half_gap):
    """The play operator: follows x (n,) with a gap of 2·half_gap; starts in the middle."""
    out, now = [], float(x[0])
    for value in x.tolist():
        now = min(max(now, value - half_gap), value + half_gap)
        out.append(now)
    return np.array(out)


def flank(torque, hold):
    """Which flank a loaded gear rests on: -1 or 1 (n,). It changes over when the torque (n,) has
    reversed and exceeds `hold`, the drag that keeps the link in place."""
    sign = np.where(torque > hold, 1.0, np.where(torque < -hold, -1.0, 0.0))
    if sign[0] == 0:
        sign[0] = 1.0 if torque[0] >= 0 else -1.0
    last = np.maximum.accumulate(np.where(sign != 0, np.arange(len(sign)), 0))
    return sign[last]


def bouc_wen(torque, yield_torque):
    """Bouc and Wen's loop, rate-independent, driven by torque (n,): z in [-1, 1]; dz = (1 − z·sign(dτ))
    dτ/yield, solved exactly between samples. Starts at zero."""
    z, now, before = [], 0.0, float(torque[0])
    for value in torque.tolist():
        side = 1.0 if value >= before else -1.0
        now = side - (side - now) * math.exp(-abs(value - before) / yield_torque)
        before = value
        z.append(now)
    return np.array(z)


def prandtl_ishlinskii(torque, yield_torque):
    """A loop of elastic and sliding elements that slide one after another up to nearly four times the
    yield torque, driven by torque (n,): in [-1, 1]. As with bouc_wen, yield_torque is the integral of
    1 - z over a torque that rises from 0."""
    thresholds = yield_torque * np.array([0.4, 1.2, 2.0, 2.8, 3.6])
    total = np.zeros_like(torque)
    for threshold in thresholds:
        total += (torque - torque[0] - motion_play(torque - torque[0], threshold)) / threshold
    return total / len(thresholds)


def mode(values, step, frequency, damping):
    """Response of a second-order mode with unit static gain to values (n,), starting in equilibrium."""
    omega = 2 * np.pi * frequency
    system = signal.cont2discrete(([omega**2], [1.0, 2 * damping * omega, omega**2]), step, "foh")
    return values[0] + signal.lfilter(system[0].ravel(), system[1], values - values[0])
