"""Recordings as CSV files."""

import numpy as np

COLUMNS = {"q_cmd": [f"q_cmd_{k}" for k in range(1, 7)],
           "q_meas": [f"q_meas_{k}" for k in range(1, 7)],
           "q_link": [f"q_link_{k}" for k in range(1, 7)],
           "tau": [f"tau_{k}" for k in range(1, 7)],
           "wrench": ["fx", "fy", "fz", "mx", "my", "mz"], "xyz": ["x", "y", "z"],
           "temp_c": ["temp_c"]}


def write(path, time, groups):
    """t and groups, {name: (rows, k)}; a NaN becomes an empty cell."""
    names = [name for name in COLUMNS if name in groups]
    header = ["t"] + [column for name in names for column in COLUMNS[name]]
    table = np.column_stack([time] + [groups[name] for name in names])
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(header) + "\n")
        for row in table:
            file.write(",".join("" if value != value else f"{value:.11g}" for value in row) + "\n")
