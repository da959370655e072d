"""Tables of Parquet, such as LeRobot's, by the rules of `flexcomp convert`."""

import pathlib
import tempfile

from . import commands
from .foreign import Unusable, package

EPISODE = "episode_index"  # LeRobot's column


def convert(source, out, rules, episode=None):
    """Writes a recording, and returns what there is to say of it. `rules`: as of `flexcomp convert --map`;
    items of a list have its name with [0], [1] and so on. Raises Unusable, or CommandError for rules."""
    table = _of_episode(_flat(_read(source), source), episode, source)
    if not rules:
        raise Unusable(f"{source}: which column is which? Say it with --map; it has {', '.join(table.columns)}")
    with tempfile.TemporaryDirectory() as folder:
        text = pathlib.Path(folder) / f"{source.stem}.csv"
        table.to_csv(text, index=False)
        return commands.run("convert", text, map=list(rules), out=out).strip()


def _read(source):
    arrow = package("pyarrow.parquet", "pyarrow", source)
    try:
        return arrow.read_table(source).to_pandas()
    except (OSError, ValueError) as error:
        raise Unusable(f"{source}: {' '.join(str(error).split())}") from error


def _flat(frame, source):
    """Lists of numbers as columns of their own."""
    import numpy
    import pandas
    if frame.empty:
        raise Unusable(f"{source}: no rows")
    columns = {}
    for name, values in frame.items():
        first = values.iloc[0]
        if not isinstance(first, numpy.ndarray):
            columns[name] = values
            continue
        if first.ndim != 1 or {len(row) for row in values} != {len(first)}:
            continue  # images, or lists that grow: no rule can name them
        for index, column in enumerate(numpy.stack(values.to_numpy()).T):
            columns[f"{name}[{index}]"] = column
    return pandas.DataFrame(columns, index=frame.index)


def _of_episode(table, episode, source):
    if EPISODE not in table:
        return table
    there = sorted(set(table[EPISODE]))
    if episode is None and len(there) > 1:
        raise Unusable(f"{source}: which episode? Say --episode, from {there[0]} to {there[-1]}")
    if episode is not None and episode not in there:
        raise Unusable(f"{source}: has no episode {episode}; expected {there[0]} to {there[-1]}")
    return table if episode is None else table[table[EPISODE] == episode]
