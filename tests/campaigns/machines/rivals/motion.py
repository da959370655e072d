"""Recordings as all rivals read them: low-passed angles, their derivatives, and torques as measured."""

import dataclasses
import pathlib

import numpy as np
import yaml
from scipy import signal

from ..tables import columns_of, read_recording

ORDER = 4  # of the Butterworth filter, run both ways
EDGE = 0.25  # s at either end, where the filter is not itself


@dataclasses.dataclass
class Motion:
    """time (n,) s; angle, speed, acceleration (n, joints), low-passed at a cut-off (Hz); raw (n, joints),
    not; torque (n, joints) N·m. For joints that slide m and N."""

    time: np.ndarray
    angle: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray
    raw: np.ndarray
    cutoff: float

    @property
    def inner(self):
        """Which rows (n,) are away from the ends."""
        return (self.time >= self.time[0] + EDGE) & (self.time <= self.time[-1] - EDGE)

    @property
    def rate(self):
        """Samples a second."""
        return 1 / float(np.median(np.diff(self.time)))

    @property
    def even(self):
        """Times (m,) at that rate, without gaps."""
        return np.arange(self.time[0], self.time[-1], 1 / self.rate)

    def at(self, time, values):
        """Values (n, k) of the rows, at other times (m,) -> (m, k)."""
        return np.column_stack([np.interp(time, self.time, column) for column in values.T])

    def rows(self, chosen):
        """A motion of the chosen rows only: a mask or a slice."""
        arrays = {field.name: getattr(self, field.name)[chosen] for field in dataclasses.fields(self)
                  if field.name != "cutoff"}
        return dataclasses.replace(self, **arrays)


def read(path, cutoff):
    recording = read_recording(path)
    time = recording["t"]
    raw, torque = (np.column_stack([recording[name] for name in columns_of(recording, group)])
                   for group in ("q_meas", "tau"))
    even = np.arange(time[0], time[-1], np.median(np.diff(time)))
    angle = np.column_stack([np.interp(even, time, column) for column in raw.T])
    numerator, denominator = signal.butter(ORDER, 2 * cutoff * np.median(np.diff(time)))
    angle = signal.filtfilt(numerator, denominator, angle, axis=0)
    speed = np.gradient(angle, even, axis=0)
    smooth = (angle, speed, np.gradient(speed, even, axis=0))
    at_rows = [np.column_stack([np.interp(time, even, column) for column in values.T])
               for values in smooth]
    return Motion(time, *at_rows, torque, raw, cutoff)


@dataclasses.dataclass
class Nominal:
    """The robot that everybody starts from. urdf: a path; gravity (3,) m/s²; rotor (joints,) kg·m²."""

    urdf: pathlib.Path
    gravity: list
    rotor: np.ndarray


def nominal(path):
    """From a robot.yaml."""
    document = yaml.safe_load(path.read_text(encoding="utf-8"))
    rotor = np.array([keys.get("rotor_inertia", 0.0) for keys in document["joints"].values()])
    return Nominal(path.parent / document["urdf"], document["gravity"], rotor)
