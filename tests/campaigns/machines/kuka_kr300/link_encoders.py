"""Regression of link-side less motor-side angles: beside the diagnosis, to check
it."""

import dataclasses

import numpy as np

from ..study import speed_of
from ..tables import read_recording


@dataclasses.dataclass
class Regression:
    """delay: s, of the link-side encoder; explained: share of the variance about the zeros, 0…1;
    zeros: rad, a recording each."""

    delay: float
    explained: float
    zeros: list


def regress(recordings, axis):
    """difference = zero of the recording - delay · speed, over recordings' paths."""
    difference, speed, which = [], [], []
    for number, path in enumerate(recordings):
        table = read_recording(path)
        difference.append(table[f"q_link_{axis}"] - table[f"q_meas_{axis}"])
        speed.append(speed_of(table, axis))
        which.append(np.full(len(table["t"]), number))
    which, target = np.concatenate(which), np.concatenate(difference)
    zeros = (which[:, None] == np.arange(len(recordings))).astype(float)
    columns = np.column_stack([-np.concatenate(speed), zeros])
    solution = np.linalg.lstsq(columns, target, rcond=None)[0]
    left = target - columns @ solution
    about_zeros = target - zeros @ np.linalg.lstsq(zeros, target, rcond=None)[0]
    return Regression(float(solution[0]), float(1 - left.var() / about_zeros.var()),
                      solution[1:].tolist())
