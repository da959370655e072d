"""Usage: tools/bench [--json FILE] [--repetitions N]

Measures flexcomp beside other libraries, in one run, and prints the ratios. Machines are noisy: the
medians of several repetitions are compared, never times with times of another day.
"""

import argparse
import csv
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

import map_numpy

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(os.environ["FLEXCOMP_BIN"])
KR270 = SOURCE / "host" / "robots" / "kr270"


def google_benchmark(program, repetitions):
    """Of each of its benchmarks: {name: points per second, median}."""
    done = subprocess.run([BIN / program, "--benchmark_format=json", f"--benchmark_repetitions={repetitions}",
                           "--benchmark_report_aggregates_only=true", "--benchmark_enable_random_interleaving=true"],
                          capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{program}: {done.stderr.strip()}")
    found = {}
    for run in json.loads(done.stdout)["benchmarks"]:
        if run.get("error_occurred"):
            sys.exit(f"{program}: {run['name']}: {run['error_message']}")
        if run["aggregate_name"] == "median":
            found[run["run_name"].removesuffix("/real_time")] = run["points"]
    return found


def numpy_map(repetitions, together):
    """Points per second, median, over the nodes that flexcomp's map reaches."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([BIN / "flexcomp", "map", "--model", KR270 / "robot.yaml", "--no-limits", "--out", folder],
                       check=True, capture_output=True)
        rows = list(csv.reader((pathlib.Path(folder) / "map.csv").read_text().splitlines()))[1:]
    nodes = [[float(value) for value in row] for row in rows if row[2]]
    speeds = []
    for _ in range(repetitions):
        speed, off = map_numpy.measure(KR270, nodes, together)
        if not off < 1e-11:  # m
            sys.exit(f"the map with NumPy is off by {off} m")
        speeds.append(speed)
    return statistics.median(speeds)


def measure_map(repetitions):
    compiled = google_benchmark("bench_map", repetitions)
    one = compiled["flexcomp_map/cores:1"]
    numpy = numpy_map(repetitions, 64)
    return [
        ("flexcomp, one core", one, None),
        (f"flexcomp, {os.cpu_count()} cores", compiled["flexcomp_map/cores:0"], None),
        ("Pinocchio, one core", compiled["pinocchio_map"], 10),
        ("NumPy, 64 circles at a time", numpy, 100),
        ("NumPy, a circle at a time", numpy_map(repetitions, 1), 100),
    ]


def main():
    arguments = argparse.ArgumentParser(usage=__doc__)
    arguments.add_argument("--json", type=pathlib.Path)
    arguments.add_argument("--repetitions", type=int, default=5)
    options = arguments.parse_args()
    print("Map of circularity, KR 270 at the study's 5 cm: path points a second", flush=True)
    rows = measure_map(options.repetitions)
    one = rows[0][1]
    for name, speed, goal in rows:
        ratio = f"flexcomp is {one / speed:6.1f} times as fast (goal {goal})" if goal else f"{speed / one:.2f}"
        print(f"  {name:30} {speed:14,.0f}   {ratio}", flush=True)
    if options.json:
        options.json.write_text(json.dumps({name: speed for name, speed, _ in rows}, indent=2) + "\n")


if __name__ == "__main__":
    main()
