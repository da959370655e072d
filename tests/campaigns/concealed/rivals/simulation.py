"""The recording that a model expects, by `flexcomp simulate`."""

import pathlib
import subprocess
import tempfile

from . import recording


class SimulationFailed(Exception):
    """flexcomp simulate gave no result; says why."""


def simulate(tool, model, path):
    """{channel: (n, columns)} for the rows of the recording at path; NaN where nothing is
    predicted."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "simulated.csv"
        words = [tool, "simulate", "--model", model, "--recording", path, "--out", out]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SimulationFailed(done.stderr.strip() or f"exit {done.returncode}")
        return recording.read(out).channels
