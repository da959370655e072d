"""Section 2 of the file formats: one CSV, a row a sample, groups of columns whole or absent."""

import numpy as np

COLUMNS = {
    "q_cmd": [f"q_cmd_{k}" for k in range(1, 7)],
    "q_meas": [f"q_meas_{k}" for k in range(1, 7)],
    "q_link": [f"q_link_{k}" for k in range(1, 7)],
    "tau": [f"tau_{k}" for k in range(1, 7)],
    "wrench": ["fx", "fy", "fz", "mx", "my", "mz"],
    "xyz": ["x", "y", "z"],
    "temp_c": ["temp_c"],
}
DIGITS = {"q_cmd": 12, "q_meas": 12, "q_link": 9, "tau": 3, "wrench": 4, "xyz": 8, "temp_c": 3}


def write(path, time, groups):
    """time (n,) s; groups: {name of COLUMNS: (n, its columns)}, NaN for a missing sample."""
    names = [name for name in COLUMNS if name in groups]
    lines = [",".join(["t"] + [column for name in names for column in COLUMNS[name]])]
    table = np.column_stack([groups[name] for name in names])
    forms = ["%%.%df" % DIGITS[name] for name in names for _ in COLUMNS[name]]
    row_form = ",".join(["%.7f"] + forms)
    for moment, row in zip(time, table):
        line = row_form % (moment, *row)
        lines.append(line.replace("nan", "") if "nan" in line else line)
    path.write_text("\n".join(lines) + "\n")
