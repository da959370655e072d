"""Recordings as columns of numbers."""

import csv
import dataclasses

import numpy as np

JOINTS = range(1, 7)
GROUPS = {
    "q_cmd": [f"q_cmd_{k}" for k in JOINTS],
    "q_meas": [f"q_meas_{k}" for k in JOINTS],
    "q_link": [f"q_link_{k}" for k in JOINTS],
    "tau": [f"tau_{k}" for k in JOINTS],
    "wrench": ["fx", "fy", "fz", "mx", "my", "mz"],
    "xyz": ["x", "y", "z"],
    "temp_c": ["temp_c"],
}
CHANNELS = {"tcp_position": "xyz", "joint_torque": "tau", "joint_deflection": "q_link"}


@dataclasses.dataclass
class Recording:
    """SI units; NaN where a cell is empty."""

    time: np.ndarray  # (n,) s
    groups: dict  # name of GROUPS -> (n, its columns)

    @property
    def is_static(self):
        """A load test: rows are poses, counted, not moments of a motion."""
        return len(self.time) > 1 and bool(np.all(np.diff(self.time) == 1))

    @property
    def angles(self):
        """Joint angles (n, 6) rad as the simulation takes them: measured, else commanded."""
        return self.groups["q_meas"] if "q_meas" in self.groups else self.groups["q_cmd"]

    @property
    def channels(self):
        """{channel: (n, columns)}, what a simulation is compared with."""
        return {channel: self.groups[group] for channel, group in CHANNELS.items()
                if group in self.groups}


def read(path):
    """A CSV of the recordings' format -> Recording."""
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    table = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows])
    table = table.reshape(-1, len(header))
    place = {column: k for k, column in enumerate(header)}
    return Recording(table[:, place["t"]],
                     {group: table[:, [place[column] for column in columns]]
                      for group, columns in GROUPS.items() if columns[0] in place})
