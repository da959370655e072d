"""The kinds of recording, and how a case's recordings are drawn for an effect.

circle  a milled circle: wrench and TCP measured
air     the same circle without cutting: TCP measured
torque  free excitation of all joints: torques measured
link    the same with link-side encoders
static  static load tests: rows are poses and loads
mixed   slow work over the whole reach with every channel, twice
"""

import dataclasses

import numpy as np

from . import loads, trajectories
from .machine import Drive

KINDS = ("circle", "air", "torque", "link", "static", "mixed")
ROOM = 25.0  # °C at the start
QUICKEST = 10.0  # s: heat takes 8 s through 10 mm of steel
LATEST = 0.07  # s, more than any column comes late


@dataclasses.dataclass
class Take:
    """One recording to be: what the robot does, which columns are written, which samples (numbers on
    the drive's grid, fractions where time steps are uneven)."""

    name: str
    drive: Drive
    columns: tuple  # of recording.COLUMNS
    rows: np.ndarray
    holdout: bool = False

    @property
    def time(self):
        time = self.drive.track.time
        return time[0] + self.rows * (time[1] - time[0])


def _temperature(rng, time, warming):
    if not warming:
        return ROOM + rng.uniform(-1, 1) * np.ones(len(time))
    rise, constant = rng.uniform(4, 15), rng.uniform(0.3, 1.2) * (time[-1] - time[0])
    constant = max(constant, QUICKEST)
    return ROOM + rise * -np.expm1(-(time - time[0]) / constant)


def _rows(rng, track, uneven):
    """All samples but those next to the ends, where a late column would have to show what was before;
    where uneven, each somewhere between its neighbours, some left out."""
    edge = int(np.ceil(LATEST / track.step))
    rows = np.arange(edge, len(track.time) - edge, dtype=float)
    if not uneven:
        return rows
    rows += rng.uniform(-0.35, 0.35, len(rows))
    return rows[rng.random(len(rows)) > 0.02]


def _encoders(rng, hints):
    wanted = hints.get("encoders")
    return (wanted,) if wanted else [("q_meas",), ("q_cmd", "q_meas"), ("q_cmd",)][rng.choice(
        3, p=[0.5, 0.35, 0.15])]


def _with_temperature(rng, columns, warming):
    shown = rng.random() < (0.7 if warming else 0.25)
    return columns + ("temp_c",) if shown else columns


def _timing(rng, hints):
    """Rate in Hz and duration in s of a circle."""
    if hints.get("warming"):
        return 100, float(rng.uniform(90, 150))
    rate = int(rng.choice([rate for rate in (100, 200, 250, 500, 1000) if rate >= hints.get("rate", 0)]))
    return rate, float(np.clip(rng.uniform(4000, 9000) / rate, 8, 60))


def _circles(rng, robot, quality, hints, cutting):
    """cutting: N the robot is rated for; 0 in the air."""
    rate, duration = _timing(rng, hints)
    radius, plane = rng.uniform(0.05, 0.18), str(rng.choice(list(trajectories.PLANES)))
    laps = max(1, round(duration * rng.uniform(0.015, 0.06) / (2 * np.pi * radius)))
    force = cutting * rng.uniform(0.4, 1.0)
    senses = [False, True] if rng.random() < 0.5 else [bool(rng.random() < 0.5)]
    columns = _with_temperature(rng, tuple(_encoders(rng, hints)) + ("xyz",), hints.get("warming"))
    columns += ("wrench",) if cutting else ()
    same = int(rng.integers(2**63))  # the same circle in both senses
    takes = []
    for number in range(len(senses) + 1):
        holdout = number == len(senses)
        if holdout and rng.random() < 0.6:
            break
        clockwise = senses[number % len(senses)]
        track, phase = trajectories.circle(robot, np.random.default_rng(same), rate, duration, radius,
                                           plane, laps, clockwise)
        wrench = (loads.milling(rng, track.time, phase, plane, force, min(35.0, 0.3 * rate))
                  if cutting else np.zeros((len(track.time), 6)))
        if clockwise and cutting:
            wrench[:, :3] *= rng.uniform(0.8, 1.2)
        drive = Drive(track, wrench, _temperature(rng, track.time, hints.get("warming")))
        takes.append(Take("holdout" if holdout else "cw" if clockwise else "ccw", drive, columns,
                          _rows(rng, track, quality.uneven), holdout))
    return takes


def _program(rng, robot, hints, rate, duration, centre):
    program = hints.get("program") or ("moves" if rng.random() < 0.25 else "fourier")
    if program == "moves":
        return trajectories.moves(robot, rng, rate, duration, rng.uniform(0.5, 0.9), centre)
    slow = hints.get("speed") == "slow"
    return trajectories.fourier(robot, rng, rate, duration, rng.uniform(0.04, 0.1),
                                rng.uniform(0.15, 0.35) if slow else rng.uniform(0.5, 0.9), centre)


def _free(rng, robot, quality, hints, columns):
    rate = int(rng.choice([rate for rate in (100, 200, 250, 500) if rate >= hints.get("rate", 0)]))
    duration = float(np.clip(rng.uniform(4000, 8000) / rate, 15, 60))
    centre = trajectories.working_posture(robot, rng)
    takes = []
    for number in range(2 if rng.random() < 0.4 else 1):
        track = _program(rng, robot, hints, rate, duration, centre)
        if not trajectories.within_limits(robot, track.q):
            raise trajectories.Unreachable("joint limits")
        n = len(track.time)
        drive = Drive(track, np.zeros((n, 6)), _temperature(rng, track.time, hints.get("warming")))
        takes.append(Take("holdout" if number else "free", drive, columns,
                          _rows(rng, track, quality.uneven), bool(number)))
    return takes


def _static(rng, robot, quality, hints, rated):
    columns = _with_temperature(rng, tuple(_encoders(rng, hints)) + ("wrench", "xyz"),
                                hints.get("warming"))
    takes = []
    for number in range(2 if rng.random() < 0.3 else 1):
        count, steps = int(rng.integers(12, 25)), int(rng.integers(2, 5))
        wrench = loads.load_steps(rng, count, steps, rated * rng.uniform(0.5, 1.2))
        track = trajectories.poses(robot, rng, count, len(wrench) // count)
        drive = Drive(track, wrench, _temperature(rng, track.time, hints.get("warming")), static=True)
        takes.append(Take("holdout" if number else "static", drive, columns,
                          np.arange(len(wrench), dtype=float), bool(number)))
    return takes


def _mixed(rng, robot, quality, hints, rated):
    rate = max(100, hints.get("rate", 0))
    duration = rng.uniform(40, 70)
    columns = ("q_cmd", "q_meas", "tau", "wrench", "xyz") + (("q_link",) if rng.random() < 0.4 else ())
    columns = _with_temperature(rng, columns, hints.get("warming"))
    centre, force = trajectories.working_posture(robot, rng), rated * rng.uniform(0.4, 1.0)
    takes = []
    for name in ("first", "second", "holdout")[:3 if rng.random() < 0.5 else 2]:
        track = trajectories.fourier(robot, rng, rate, duration, rng.uniform(0.02, 0.05),
                                     rng.uniform(0.05, 0.25), centre)
        if not trajectories.within_limits(robot, track.q):
            raise trajectories.Unreachable("joint limits")
        drive = Drive(track, loads.pushing(rng, track.time, force),
                      _temperature(rng, track.time, hints.get("warming")))
        takes.append(Take(name, drive, columns, _rows(rng, track, quality.uneven),
                          name == "holdout"))
    return takes


def draw(kind, rng, robot, quality, hints, rated):
    """The takes of a case. rated: N, what the robot is made to carry. Raises Unreachable where they do
    not fit the robot's limits."""
    if kind in ("circle", "air"):
        return _circles(rng, robot, quality, hints, rated if kind == "circle" else 0.0)
    if kind == "static":
        return _static(rng, robot, quality, hints, rated)
    if kind == "mixed":
        return _mixed(rng, robot, quality, hints, rated)
    columns = tuple(_encoders(rng, hints)) + ("tau",) if kind == "torque" else ("q_meas", "q_link")
    if kind == "link" and (hints.get("torque") or rng.random() < 0.7):
        columns += ("tau",)
    return _free(rng, robot, quality, hints, columns)
