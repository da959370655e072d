"""Input of the black boxes: all in a recording but the channel they are to explain."""

import dataclasses

import numpy as np
from scipy.signal import savgol_filter

SMOOTHING = 0.06  # s, over which angles are smoothed for their derivatives
STRETCHES = 8  # of a recording, for validation


@dataclasses.dataclass
class Table:
    """One row a sample; columns by name, so that a rival can treat angles as angles."""

    columns: dict  # name -> (n, its columns)
    stretch: np.ndarray  # (n,) which eighth of its recording a row lies in
    rows_rest: bool  # poses at rest

    @property
    def matrix(self):
        return np.concatenate(list(self.columns.values()), axis=1)

    def only(self, names):
        return dataclasses.replace(self, columns={name: self.columns[name] for name in names})

    def take(self, rows):
        return Table({name: values[rows] for name, values in self.columns.items()},
                     self.stretch[rows], self.rows_rest)


def _derivatives(time, angles):
    """Velocity and acceleration (n, 6) by local cubics (Savitzky and Golay, 1964)."""
    step = np.median(np.diff(time))
    even = np.arange(time[0], time[-1] + step / 2, step)
    window = min(2 * int(SMOOTHING / step / 2) + 1, len(even) - 1 + len(even) % 2)
    window = max(window, 5)
    found = []
    for order in (1, 2):
        smooth = [savgol_filter(np.interp(even, time, column), window, 3, deriv=order, delta=step)
                  for column in angles.T]
        found.append(np.column_stack([np.interp(time, even, column) for column in smooth]))
    return found


def _filled(time, values):
    """Gaps closed by straight lines; zeros where a column has nothing at all."""
    values = values.copy()
    for column in values.T:
        there = np.isfinite(column)
        column[~there] = np.interp(time[~there], time[there], column[there]) if there.any() else 0.0
    return values


def table(recording, channel):
    """Features of a recording for one channel -> Table."""
    time = recording.time
    angles = _filled(time, recording.angles)
    columns = {"angle": angles}
    if not recording.is_static:
        velocity, acceleration = _derivatives(time, angles)
        columns |= {"velocity": velocity, "acceleration": acceleration}
    for group in ("wrench", "tau", "temp_c"):
        if group in recording.groups and not (group == "tau" and channel == "joint_torque"):
            columns[group] = _filled(time, recording.groups[group])
    stretch = np.arange(len(time)) * STRETCHES // max(1, len(time))
    return Table(columns, stretch, recording.is_static)


def join(tables):
    """Several recordings' rows, one after the other."""
    names = [name for name in tables[0].columns if all(name in each.columns for each in tables)]
    return Table({name: np.concatenate([each.columns[name] for each in tables]) for name in names},
                 np.concatenate([each.stretch for each in tables]), tables[0].rows_rest)


def validation_rows(stretch):
    """Two whole stretches of eight: neighbouring samples are no test of one another."""
    return (stretch == 2) | (stretch == 6)


def thinned(rows, most):
    """At most so many of the row numbers, evenly."""
    rows = np.asarray(rows)
    return rows if len(rows) <= most else rows[np.linspace(0, len(rows) - 1, most).astype(int)]
