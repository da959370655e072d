"""Tables in CSV files: published ones, held to the columns they should have, and recordings."""

import csv
import math

import numpy as np

MOST_JOINTS = 12
COLUMNS = {  # as many of a group as there are joints
    **{name: [f"{name}_{k}" for k in range(1, MOST_JOINTS + 1)]
       for name in ("q_cmd", "q_meas", "q_link", "tau")},
    "xyz": ["x", "y", "z"],
}


class Damaged(Exception):
    """A file is not what its reader expects; the message names file and place."""


def read_text(path):
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise Damaged(f"{path}: no text (byte {error.start})") from error


def _number(cell, where):
    try:
        value = float(cell)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise Damaged(f"{where}: '{cell}' is no number")
    return value


def read_table(path, columns, rising=None):
    """The named columns of a CSV file with a header: {name: (n,)}. `rising`: the one that must
    grow."""
    rows = list(csv.reader(read_text(path).splitlines()))
    if len(rows) < 2:
        raise Damaged(f"{path}: holds no rows")
    header = rows[0]
    for name in columns:
        if name not in header:
            raise Damaged(f"{path}:1: there is no column '{name}'")
    places = [header.index(name) for name in columns]
    values = np.empty((len(rows) - 1, len(columns)))
    for line, row in enumerate(rows[1:], 2):
        if len(row) != len(header):
            raise Damaged(f"{path}:{line}: {len(row)} cells under a header of {len(header)}")
        values[line - 2] = [_number(row[place], f"{path}:{line}: column '{name}'")
                            for place, name in zip(places, columns)]
    table = dict(zip(columns, values.T))
    if rising is not None and np.any(np.diff(table[rising]) <= 0):
        line = int(np.argmax(np.diff(table[rising]) <= 0)) + 3
        raise Damaged(f"{path}:{line}: column '{rising}' does not grow")
    return table


def stacked(table, form, numbers):
    """Columns named by a form such as "q_{}" -> (n, their count)."""
    return np.column_stack([table[form.format(number)] for number in numbers])


def write_recording(path, time, **groups):
    """time (n,) in s; groups by names of COLUMNS, (n, joints or three); not-a-number for a missing
    sample."""
    header, columns = ["t"], [np.asarray(time, float)[:, None]]
    for name, values in groups.items():
        columns.append(np.asarray(values, float))
        header += COLUMNS[name][:columns[-1].shape[1]]
    with path.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for row in np.hstack(columns).tolist():
            writer.writerow(["" if math.isnan(value) else f"{value:.12g}" for value in row])
    return path


def read_recording(path):
    """A recording's columns, {name: (n,)}, not-a-number for a missing sample."""
    rows = list(csv.reader(read_text(path).splitlines()))
    values = [[float(cell) if cell else math.nan for cell in row] for row in rows[1:]]
    return dict(zip(rows[0], np.array(values).T))


def columns_of(recording, group):
    """The names of a group's columns that a recording has."""
    return [name for name in COLUMNS[group] if name in recording]
