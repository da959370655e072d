"""The map of circularity beside Pinocchio and NumPy."""

import csv
import os
import pathlib
import statistics
import tempfile

from .. import numpy_map
from ..programs import BIN, KR270, Failed, google_benchmark, run
from ..result import Curve, Figure, Ratio, Topic

STEPS = (200, 100, 50, 25)  # mm


def _numpy(repetitions, together):
    """Points per second, median, over the nodes that flexcomp's map reaches."""
    with tempfile.TemporaryDirectory() as folder:
        run(BIN / "flexcomp", "map", "--model", KR270 / "robot.yaml", "--no-limits", "--out", folder)
        rows = list(csv.reader((pathlib.Path(folder) / "map.csv").read_text().splitlines()))[1:]
    nodes = [[float(value) for value in row] for row in rows if row[2]]
    speeds = []
    for _ in range(repetitions):
        speed, off = numpy_map.measure(KR270, nodes, together)
        if not off < 1e-11:  # m
            raise Failed(f"the map with NumPy is off by {off} m")
        speeds.append(speed)
    return statistics.median(speeds)


def measure(repetitions):
    found = google_benchmark("bench_map", repetitions)
    cores = len(os.sched_getaffinity(0))
    one, all_cores = (found[f"flexcomp_map/cores:{n}/step:50"]["points"] for n in (1, 0))
    pinocchio = found["pinocchio_map"]["points"]
    # By the clock, both: what other programs leave of the cores.
    scaling = found["flexcomp_map/cores:1/step:50"]["real_time"] / found["flexcomp_map/cores:0/step:50"]["real_time"]
    together, single = _numpy(repetitions, 64), _numpy(repetitions, 1)

    def seconds(n):
        maps = [found[f"flexcomp_map/cores:{n}/step:{step}"] for step in STEPS]
        return [[entry["total"], 1e-3 * entry["real_time"]] for entry in maps]
    return Topic(
        "Map of circularity, KR 270 at the study's 5 cm, path points a second",
        [Figure("flexcomp, one core", one, "points/s"),
         Figure(f"flexcomp, {cores} cores", all_cores, "points/s"),
         Figure("Pinocchio, one core", pinocchio, "points/s"),
         Figure("NumPy, 64 circles at a time", together, "points/s"),
         Figure("NumPy, a circle at a time", single, "points/s")],
        [Ratio("flexcomp's points a second / Pinocchio's", one / pinocchio, 10),
         Ratio("flexcomp's points a second / NumPy's, 64 circles at a time", one / together, 100),
         Ratio("flexcomp's points a second / NumPy's, a circle at a time", one / single, 100),
         Ratio(f"time on one core / on {cores}", scaling)],
        [Curve("one core", seconds(1)), Curve(f"{cores} cores", seconds(0))],
        ("path points of the map", "a map, s"))
