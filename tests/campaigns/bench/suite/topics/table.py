"""Cost of building, checking and keeping a table."""

from ..programs import google_benchmark
from ..result import Curve, Figure, Ratio, Topic, quantity


def measure(repetitions):
    found = google_benchmark("bench_table", repetitions)
    path = {k: found[f"build_path/{k}"] for k in range(4, 8)}
    grid = {k: found[f"build_grid/{k}"] for k in range(3, 6)}
    plain = {k: found[f"plain_grid/{k}"]["bytes"] for k in path}
    error = {k: quantity(entry["certified"], "m") for k, entry in path.items()}
    return Topic(
        "Tables: the circle of 720 pieces, error certified for 1750 N",
        [Figure("to build a path table of 1 µm", path[6]["s"], "s"),
         Figure("to build one of 0.1 µm", path[7]["s"], "s"),
         Figure("to build a grid table of 10 µm", grid[5]["s"], "s"),
         Figure("to verify it at one place", found["verify/6"]["s"], "s"),
         Figure("to check a table of 1 µm before use", found["open_table/6"]["s"], "s"),
         *(Figure(f"path table, certified to {error[k]}", path[k]["bytes"], "bytes") for k in path),
         *(Figure(f"plain grid, off by up to {error[k]}, not certified", plain[k], "bytes") for k in path)],
        [Ratio(f"plain grid / path table, bytes, {error[k]}", plain[k] / path[k]["bytes"]) for k in path],
        [Curve("path table", [[1e6 * entry["certified"], entry["bytes"]] for entry in path.values()]),
         Curve("plain uniform grid", [[1e6 * path[k]["certified"], plain[k]] for k in path]),
         Curve("grid table", [[1e6 * entry["certified"], entry["bytes"]] for entry in grid.values()])],
        ("error, µm", "bytes"))
