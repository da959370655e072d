"""Every rival on the recordings of a machine, beside flexcomp, and the table of them in the page."""

import ast
import dataclasses
import json
import math
import os
import pathlib
import subprocess

import numpy as np

from .. import study
from ..tables import columns_of, read_recording

HERE = pathlib.Path(__file__).resolve().parent
PAGE = HERE.parent / "README.md"
PYTHON = "FLEXCOMP_RIVALS_PYTHON"
BEGIN = "<!-- written by tools/diagnose-machines --rivals -->"
END = "<!-- end of rivals -->"
HEADER = ["| recording | method | held out, rms | processor | lines | what it says is missing |",
          "|---|---|---|---|---|---|"]
RIVALS = {"regression": "plain regression", "figaroh_identification": "FIGAROH 1.0.2",
          "mujoco_sysid": "mujoco.sysid 4.0.0"}
EDGE = 0.25  # s at either end that nobody is judged by: filters end there
LONGEST = 160  # characters of what a rival says
PATIENCE = 3600  # s


class NoRivals(Exception):
    """The rivals' Python is not there."""


@dataclasses.dataclass
class Result:
    """error: N·m or N, root mean square, or None where it failed; seconds of a processor; lines that its
    user writes; missing: what it says is missing."""

    method: str
    error: float | None
    seconds: float
    lines: int
    missing: str


def lines_of_code(path):
    """Of a Python file, without comments, docstrings and blank lines."""
    text = path.read_text(encoding="utf-8")
    code = {number for number, line in enumerate(text.splitlines(), 1) if line.split("#")[0].strip()}
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            code -= set(range(node.lineno, node.end_lineno + 1))
    return len(code)


def _judged(measured, answer):
    """Rows (n,) away from the ends, of which flexcomp's own answer says something."""
    time = measured["t"]
    inner = (time > time[0] + EDGE) & (time < time[-1] - EDGE)
    return inner & np.isfinite(_torque(answer)).any(axis=1)


def _torque(recording):
    return np.column_stack([recording[name] for name in columns_of(recording, "tau")])


def _rms(measured, answer, rows):
    return study.rms((_torque(measured) - _torque(answer))[rows])


def _run(rival, experiment, folder):
    """A rival's Result without its error, and the path of its answer. Raises NoRivals."""
    out = folder / f"{rival}.csv"
    words = [os.environ.get(PYTHON, ""), "-W", "ignore", "-m", "machines.rivals", rival, "--model", experiment.model,
             "--holdout", experiment.holdout, "--out", out]
    for recording in experiment.recordings:
        words += ["--recording", recording]
    lines = lines_of_code(HERE / f"{rival}.py")
    try:
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True, timeout=PATIENCE)
    except OSError as error:
        raise NoRivals(f"{PYTHON} names no Python with the rivals' packages: {error.strerror}") from error
    except subprocess.TimeoutExpired:
        return Result(RIVALS[rival], None, PATIENCE, lines, "no answer within an hour"), out
    if done.returncode != 0:
        said = (done.stderr.strip().splitlines() or ["says nothing"])[-1]
        return Result(RIVALS[rival], None, 0.0, lines, f"failed: {said}"), out
    said = json.loads(done.stdout.strip().splitlines()[-1])
    return Result(RIVALS[rival], None, said["seconds"], lines, said["missing"]), out


def compare(outcome, folder, show):
    """Results of flexcomp and of all rivals on an experiment with torques."""
    rows = _judged(outcome.measured, outcome.after)
    found = study.names(outcome.answer.findings)
    results = [Result("as modelled", _rms(outcome.measured, outcome.before, rows), 0.0, 0, ""),
               Result("flexcomp", _rms(outcome.measured, outcome.after, rows), outcome.seconds, 1,
                      found)]
    for rival in RIVALS:
        show(f"{outcome.experiment.name}: {RIVALS[rival]}")
        result, path = _run(rival, outcome.experiment, folder)
        if path.is_file() and not result.missing.startswith(("failed", "no answer")):
            result.error = _rms(outcome.measured, read_recording(path), rows)
        results.append(result)
    return results


def _shortened(text):
    text = " ".join(text.split()).replace("|", "/")
    return text if len(text) <= LONGEST else text[:LONGEST].rsplit(" ", 1)[0] + " …"


def lines_of_table(name, unit, results):
    lines = []
    for result in results:
        error = "–" if result.error is None else f"{result.error:.4g} {unit}"
        seconds = "–" if math.isnan(result.seconds) else f"{result.seconds:.1f} s"
        lines.append(f"| {name} | {result.method} | {error} | {seconds} | {result.lines} | "
                     f"{_shortened(result.missing) or 'nothing'} |")
    return lines


def update_page(rows, page=PAGE):
    """rows: {recording: lines}. Those of other recordings in the table stay."""
    head, rest = page.read_text(encoding="utf-8").split(BEGIN)
    table, tail = rest.split(END)
    kept = {}
    for line in table.strip().splitlines()[len(HEADER):]:
        kept.setdefault(line.split("|")[1].strip(), []).append(line)
    lines = [line for each in (kept | rows).values() for line in each]
    page.write_text("\n".join([head + BEGIN, *HEADER, *lines, END]) + tail, encoding="utf-8")
