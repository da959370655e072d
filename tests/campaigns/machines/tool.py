"""Runs the flexcomp command."""

import dataclasses
import math
import pathlib
import resource
import shutil
import subprocess

from .study import NoAnswer, Outcome, parse
from .tables import read_recording

UPDATED, BEFORE, AFTER = "updated_model.yaml", "holdout_before.csv", "holdout_after.csv"
SECONDS = "seconds"


@dataclasses.dataclass
class Tool:
    path: pathlib.Path

    def _run(self, *words):
        done = subprocess.run([str(self.path), *map(str, words)], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL)
        if done.returncode != 0:
            said = done.stderr.strip().splitlines() or ["says nothing"]
            raise NoAnswer(f"flexcomp {words[0]}: exit {done.returncode}: {said[-1]}")

    def simulate(self, model, recording, out):
        """The recording as it would be if the model were right: {column: (n,)}."""
        self._run("simulate", "--model", model, "--recording", recording, "--out", out)
        return read_recording(out)

    def diagnose(self, experiment, folder):
        """Diagnoses an experiment, answers to a folder made anew, and simulates what was held
        out."""
        shutil.rmtree(folder, ignore_errors=True)
        words = ["--model", experiment.model]
        for recording in experiment.recordings:
            words += ["--recording", recording]
        before = _seconds_of_children()
        self._run("diagnose", *words, "--holdout", experiment.holdout, "--out", folder)
        seconds = _seconds_of_children() - before
        self.simulate(experiment.model, experiment.holdout, folder / BEFORE)
        self.simulate(folder / UPDATED, experiment.holdout, folder / AFTER)
        (folder / SECONDS).write_text(f"{seconds:.2f}\n")
        return self.recall(experiment, folder)

    def recall(self, experiment, folder):
        """The outcome that a folder holds, or None."""
        if not (folder / AFTER).is_file():
            return None
        seconds = float((folder / SECONDS).read_text()) if (folder / SECONDS).is_file() else math.nan
        return Outcome(experiment, parse((folder / "diagnosis.json").read_text()), folder / UPDATED,
                       read_recording(experiment.holdout), read_recording(folder / BEFORE),
                       read_recording(folder / AFTER), seconds)


def _seconds_of_children():
    """Of a processor, of the processes that this one started."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
