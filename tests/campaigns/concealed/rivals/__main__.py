"""Runs the contest on one case and writes NAME.json for each method as soon as it is done."""

import argparse
import csv
import json
import pathlib
import signal
import sys
import time

import numpy as np

from . import contest, residual, simulation

SHOWN_ROWS = 1000  # of a picture's curve


class TooLong(Exception):
    """A method was not done in its time."""


def arguments():
    parser = argparse.ArgumentParser(prog="python3 -m rivals", description=__doc__)
    parser.add_argument("--tool", required=True, help="flexcomp")
    parser.add_argument("--model", required=True, type=pathlib.Path, help="nominal robot.yaml")
    parser.add_argument("--learned", type=pathlib.Path, help="updated_model.yaml of a diagnosis")
    parser.add_argument("--train", required=True, action="append", type=pathlib.Path)
    parser.add_argument("--holdout", required=True, type=pathlib.Path)
    parser.add_argument("--untrained", required=True, type=pathlib.Path)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a method (default 60)")
    parser.add_argument("--models-only", action="store_true", help="no rivals")
    parser.add_argument("--out", required=True, type=pathlib.Path)
    return parser.parse_args()


def _ring(*_):
    raise TooLong


def _write_curves(path, data, curves):
    """Error over time of the nominal and the diagnosed model: rms over the components of a few rows
    at a time, so that it compares with the noise."""
    bundle = max(1, -(-len(data.recording.time) // SHOWN_ROWS))
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["channel", "t", *curves])
        for channel, usable in data.usable.items():
            for begin in range(0, len(usable), bundle):
                rows = slice(begin, begin + bundle)
                pieces = [left[channel][rows] for left in curves.values()]
                errors = [residual.rms(piece, usable[rows] & np.isfinite(piece))
                          for piece in pieces]
                if None not in errors:
                    writer.writerow([channel, f"{data.recording.time[begin]:.6g}",
                                     *(f"{error:.5g}" for error in errors)])


def compete(match, methods, limit, out):
    """Each method in turn; its errors, or why it has none, go into out."""
    curves = {}
    signal.signal(signal.SIGALRM, _ring)
    for method in methods:
        begin, result = time.monotonic(), {"method": method}
        signal.setitimer(signal.ITIMER_REAL, limit)
        try:
            remainders = match.remainders(method)
            result["errors"] = match.errors(remainders)
            if method in contest.MODELS:
                curves[method] = remainders["holdout"]
        except TooLong:
            result["failed"] = f"not done within {limit:g} s"
        except (simulation.SimulationFailed, ValueError, np.linalg.LinAlgError) as error:
            result["failed"] = str(error)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        result["seconds"] = round(time.monotonic() - begin, 2)
        (out / f"{method}.json").write_text(json.dumps(result) + "\n")
        if method == contest.MODELS[-1]:
            _write_curves(out / "curves.csv", match.judged["holdout"], curves)


def main():
    options = arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    judged = {"holdout": options.holdout, "untrained": options.untrained}
    try:
        match = contest.Contest(options.tool, options.model, options.train, judged, options.learned)
    except simulation.SimulationFailed as error:
        sys.exit(f"the nominal model cannot be simulated: {error}")
    methods = contest.methods(options.learned is not None, not options.models_only)
    compete(match, methods, options.limit, options.out)


if __name__ == "__main__":
    main()
