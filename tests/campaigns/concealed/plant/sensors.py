"""Sensors between the plant and the recording: noise, steps, rates, and the logger's time stamps."""

import dataclasses

import numpy as np
from scipy.interpolate import CubicSpline

RATES = 160, 200  # Hz
LATEST = 0.07  # s that the end of a motion is not shown, for columns that come early
JITTER = 0.05  # of a period: how unevenly the logger takes its rows
FIELD_BUS_JITTER = 2e-7  # s between encoders, which share a clock
ANALOG_JITTER = 2e-5  # s of torques, forces and the tracker against them
GROUPS = ("q_cmd", "q_meas", "q_link", "tau", "wrench", "xyz", "temp_c")


@dataclasses.dataclass
class Sensors:
    """Sensors of one robot cell."""

    rate: float  # Hz, rows a second
    motor_step: float  # rad at the joint: a 20-bit encoder behind the gear
    link_step: float  # rad
    link_noise: float  # rad
    torque_noise: np.ndarray  # (6,) N·m
    torque_step: np.ndarray  # (6,) N·m
    force_noise: float  # N
    moment_noise: float  # N·m
    tracker_noise: float  # m each axis
    tracker_stride: int  # rows from one sample of the tracker to the next


def draw(rng, description, torque_peak):
    """Sensors of ordinary quality. torque_peak: (6,) N·m, the most that the motors must give."""
    ratio = rng.uniform(150, 250)
    share = rng.uniform(0.008, 0.015)
    noise = share * np.maximum(torque_peak, 0.08 * description.column("effort"))
    return Sensors(rate=float(rng.choice(RATES)), motor_step=2 * np.pi / 2**20 / ratio,
                   link_step=2 * np.pi / 2 ** int(rng.integers(19, 22)),
                   link_noise=rng.uniform(4e-6, 8e-6), torque_noise=noise, torque_step=noise / 4,
                   force_noise=rng.uniform(0.5, 1.5), moment_noise=rng.uniform(0.05, 0.2),
                   tracker_noise=rng.uniform(10e-6, 20e-6), tracker_stride=int(rng.integers(1, 3)))


def noise_levels(sensors):
    """Standard deviation of one reading of each compared channel; steps included."""
    return {"xyz": np.full(3, sensors.tracker_noise),
            "tau": np.hypot(sensors.torque_noise, sensors.torque_step / np.sqrt(12)),
            "q_link": np.full(6, np.hypot(sensors.link_noise, sensors.link_step / np.sqrt(12)))}


def _row_times(rng, sensors, signals, run_in):
    first, last = signals.time[0] + run_in, signals.time[-1] - LATEST
    even = np.arange(first, last, 1 / sensors.rate)
    return np.round(even + rng.uniform(-JITTER, JITTER, len(even)) / sensors.rate, 6)


def _at(time, values, wanted):
    """Columns of values (n, k) at other times."""
    return CubicSpline(time, values)(wanted)


def _averaged(values, width):
    """The anti-aliasing filter, a mean over `width` steps about each, which delays nothing."""
    if width < 2:
        return values
    sums = np.cumsum(np.concatenate([np.zeros((1, values.shape[1])), values]), 0)
    rows = np.arange(len(values))
    low, high = np.maximum(rows - width // 2, 0), np.minimum(rows + width // 2 + 1, len(values))
    return (sums[high] - sums[low]) / (high - low)[:, None]


def _rounded(values, step):
    return np.round(values / step) * step


def _add_noise(rng, sensors, shown):
    def normal(values):
        return rng.normal(size=values.shape)

    if "q_meas" in shown:
        shown["q_meas"] = _rounded(shown["q_meas"], sensors.motor_step)
    if "q_link" in shown:
        noisy = shown["q_link"] + sensors.link_noise * normal(shown["q_link"])
        shown["q_link"] = _rounded(noisy, sensors.link_step)
    if "tau" in shown:
        noisy = shown["tau"] + sensors.torque_noise * normal(shown["tau"])
        shown["tau"] = _rounded(noisy, sensors.torque_step)
    if "wrench" in shown:
        level = np.array([sensors.force_noise] * 3 + [sensors.moment_noise] * 3)
        shown["wrench"] = shown["wrench"] + level * normal(shown["wrench"])
    if "xyz" in shown:
        shown["xyz"] = shown["xyz"] + sensors.tracker_noise * normal(shown["xyz"])
    if "temp_c" in shown:
        shown["temp_c"] = shown["temp_c"] + 0.05 * normal(shown["temp_c"])
    return shown


def record(rng, sensors, signals, groups, run_in=0.0):
    """(t, {group: (rows, k)}): what the logger writes of the signals."""
    values = {name: getattr(signals, name).reshape(len(signals.time), -1) for name in groups}
    if signals.static:
        return signals.time, _add_noise(rng, sensors, values)
    time = _row_times(rng, sensors, signals, run_in)
    width = round(1 / sensors.rate / (signals.time[1] - signals.time[0]))
    shown = {}
    for name, dense in values.items():
        is_analog = name in ("tau", "wrench", "xyz")
        jitter = (ANALOG_JITTER if is_analog else FIELD_BUS_JITTER) * rng.normal(size=len(time))
        dense = _averaged(dense, width) if name in ("tau", "wrench") else dense
        shown[name] = _at(signals.time, dense, time + (0 if name == "q_cmd" else jitter))
    shown = _add_noise(rng, sensors, shown)
    if "xyz" in shown:
        missing = np.arange(len(time)) % sensors.tracker_stride != 0
        shown["xyz"][missing] = np.nan
    return time, shown
