"""Runs the compiled benchmarks."""

import json
import os
import pathlib
import re
import subprocess

SOURCE = pathlib.Path(__file__).resolve().parents[4]
BIN = pathlib.Path(os.environ["FLEXCOMP_BIN"])
KR270 = SOURCE / "host" / "robots" / "kr270"


class Failed(Exception):
    """A benchmark did not do what it should; says why."""


def run(*words, **options):
    """The program's standard output."""
    return run_both(*words, **options)[0]


def run_both(*words, **options):
    """The program's standard output, and its standard error."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        raise Failed(f"{pathlib.Path(words[0]).name}: {done.stderr.strip() or f'exit {done.returncode}'}")
    return done.stdout, done.stderr


def google_benchmark(program, repetitions, *arguments, seconds=0.1):
    """{benchmark: {counter: median of the repetitions}}. They take turns in random order, so that all
    of them see the same noise of the machine."""
    text = run(BIN / program, *arguments, "--benchmark_format=json", f"--benchmark_repetitions={repetitions}",
               "--benchmark_report_aggregates_only=true", "--benchmark_enable_random_interleaving=true",
               f"--benchmark_min_time={seconds}")
    found = {}
    for entry in json.loads(text)["benchmarks"]:
        if entry.get("error_occurred"):
            raise Failed(f"{program}: {entry['name']}: {entry['error_message']}")
        if entry.get("aggregate_name", "median") == "median":  # a single one is not aggregated
            found[re.sub(r"/(real_time|process_time|iterations:\d+)", "", entry["run_name"])] = entry
    return found


def on_one_core():
    """For subprocess's preexec_fn."""
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
