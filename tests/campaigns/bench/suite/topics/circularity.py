"""The reference circles beside CGAL, SciPy and circle-fit."""

import pathlib
import statistics
import tempfile
import time

import numpy as np

from .. import scipy_circles
from ..programs import Failed, google_benchmark
from ..result import Curve, Figure, Ratio, Topic

COUNTS = (100, 10_000, 1_000_000)
RADIUS = 0.1  # m
PYTHON = {"LSC SciPy": scipy_circles.least_squares, "LSC circle-fit": scipy_circles.least_squares_by_circle_fit,
          "MZC SciPy": scipy_circles.minimum_zone, "MIC SciPy": scipy_circles.inscribed,
          "MCC SciPy": scipy_circles.circumscribed}
# How far off flexcomp's value another's may be. CGAL's annulus has the least difference of squared
# radii; SciPy's simplex and a sphere in plain doubles end near the optimum only.
AGREEMENT = 1e-3  # of the form error


def profile(count):
    """A circle with lobes and noise, its middle away from the origin; (count, 2), m."""
    random = np.random.default_rng(count)
    angle = np.arange(count) * 2 * np.pi / count
    radius = (RADIUS + 20e-6 * np.cos(2 * angle) + 10e-6 * np.cos(3 * angle + 1)
              + 2e-6 * random.standard_normal(count))
    return np.column_stack([1.6 + radius * np.cos(angle), 1.2 + radius * np.sin(angle)])


def _time(find, points, repetitions):
    """Median, s, and the value found."""
    times = []
    for _ in range(repetitions if len(points) < COUNTS[-1] else 1):
        begin = time.process_time()
        found = find(points)
        times.append(time.process_time() - begin)
    return statistics.median(times), found


def _seconds(repetitions):
    """{(method, points): s}, after a check that all find the same."""
    seconds, value = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for count in COUNTS:
            points = profile(count)
            points.tofile(pathlib.Path(folder) / f"{count}.f64")
            for name, find in PYTHON.items():
                seconds[name, count], value[name, count] = _time(find, points, repetitions)
        for name, entry in google_benchmark("bench_circularity", repetitions, folder, *COUNTS).items():
            method, count = name.split("/")
            seconds[method, int(count)], value[method, int(count)] = entry["s"], entry["found"]
    for (name, count), found in value.items():
        own = value[f"{name.split()[0]} flexcomp", count]
        if abs(found - own) > AGREEMENT * value["MZC flexcomp", count]:
            raise Failed(f"{name} of {count} points: {found} m, flexcomp: {own} m")
    return seconds


def measure(repetitions):
    seconds = _seconds(repetitions)
    names = list(dict.fromkeys(name for name, _ in seconds))
    most = COUNTS[-1]

    def ratio(other, goal=None):
        method, library = other.split()
        return Ratio(f"{method}: {library}'s time / flexcomp's",
                     seconds[other, most] / seconds[f"{method} flexcomp", most], goal)
    return Topic(
        "Reference circles (least squares, minimum zone, inscribed, circumscribed) of 1,000,000 points",
        [Figure(name, seconds[name, most], "s") for name in sorted(names)],
        [ratio("MZC CGAL", 10),
         Ratio("MZC: flexcomp's time, s", seconds["MZC flexcomp", most], 1, at_most=True),
         ratio("MZC SciPy"), ratio("MCC CGAL"), ratio("MIC SciPy"),
         ratio("LSC SciPy"), ratio("LSC circle-fit")],
        [Curve(name, [[count, seconds[name, count]] for count in COUNTS]) for name in sorted(names)],
        ("points", "time, s"),
        ["SciPy's simplex searches find a local optimum, to a tolerance; flexcomp's and CGAL's are global.",
         *(f"At {count:,} points CGAL's MZC takes {seconds['MZC CGAL', count] / seconds['MZC flexcomp', count]:.2g} "
           "times as long." for count in COUNTS[:-1])])
