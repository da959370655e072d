"""Recordings as pandas frames."""

import os
import pathlib
import tempfile

import numpy
import pandas

from . import commands

_JOINT_GROUPS = ("q_cmd", "q_meas", "q_link", "tau")
_OTHER_GROUPS = {"wrench": ["fx", "fy", "fz", "mx", "my", "mz"], "position": ["x", "y", "z"], "temperature": ["temp_c"]}
_MOST_JOINTS = 12


class Recording:
    """Samples over time. `frame` has a column `t` (s) and whole groups of columns: q_cmd_1.., q_meas_1..,
    q_link_1.. (rad), tau_1.. (N·m), fx..mz (N, N·m; on the tool at the TCP, base frame), x, y, z (m), temp_c.
    Missing samples are NaN. Raises ValueError for what is not a recording."""

    def __init__(self, frame, name="recording"):
        self.frame = frame
        self.groups = _check(frame, name)

    @classmethod
    def read(cls, file):
        """From a file. Raises ValueError for what is no recording, and OSError for what cannot be read."""
        return cls(pandas.read_csv(file, dtype=float), str(file))

    @classmethod
    def from_log(cls, *logs, **options):
        """From logs of candump or lcm-logger, by `flexcomp convert`."""
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "recording.csv"
            commands.run("convert", *logs, out=out, **options)
            return cls.read(out)

    @property
    def time(self):
        """Column `t`, in s."""
        return self.frame["t"].to_numpy()

    def group(self, name):
        """A row a sample: "q_cmd", "wrench", "position" and the like. KeyError where it is not there."""
        return self.frame[self.groups[name]].to_numpy()

    def write(self, file):
        """Whole or not at all."""
        part = pathlib.Path(f"{file}.{os.getpid()}.part")
        try:
            self.frame.to_csv(part, index=False)
            os.replace(part, file)
        finally:
            part.unlink(missing_ok=True)


def _check(frame, name):
    """The groups that are there, and their columns."""
    columns = list(frame.columns)
    if "t" not in columns:
        raise ValueError(f"{name}: there is no column t")
    if not (numpy.diff(frame["t"].to_numpy(dtype=float)) > 0).all():
        raise ValueError(f"{name}: t does not grow from row to row")
    groups = {}
    for group in _JOINT_GROUPS:
        joints = [f"{group}_{j}" for j in range(1, _MOST_JOINTS + 1) if f"{group}_{j}" in columns]
        if joints != [f"{group}_{j}" for j in range(1, len(joints) + 1)]:
            raise ValueError(f"{name}: {group}_1 to {joints[-1]} are not all there")
        if joints:
            groups[group] = joints
    for group, members in _OTHER_GROUPS.items():
        there = [column for column in members if column in columns]
        if there and there != members:
            raise ValueError(f"{name}: only {', '.join(there)} of {', '.join(members)}")
        if there:
            groups[group] = members
    unknown = set(columns) - {"t"} - {column for members in groups.values() for column in members}
    if unknown:
        raise ValueError(f"{name}: unknown columns {', '.join(sorted(unknown))}")
    return groups


__all__ = ["Recording"]
