"""Runs the flexcomp command."""

import dataclasses
import pathlib
import shutil
import subprocess

from .study import NoAnswer, Outcome, parse
from .tables import read_recording


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
        self._run("diagnose", *words, "--holdout", experiment.holdout, "--out", folder)
        answer = parse((folder / "diagnosis.json").read_text())
        updated = folder / "updated_model.yaml"
        return Outcome(
            experiment, answer, updated, read_recording(experiment.holdout),
            self.simulate(experiment.model, experiment.holdout, folder / "holdout_before.csv"),
            self.simulate(updated, experiment.holdout, folder / "holdout_after.csv"))
