"""One trial: a case is made, diagnosed, judged."""

import dataclasses
import hashlib
import json
import pathlib
import shutil
import signal
import subprocess
import time

from generator import case, setup

from . import answer, judge

GENERATOR = pathlib.Path(case.__file__).parent


def generator_digest():
    """Changes with any line of the generator or of the robots, so that no stale case is used."""
    digest = hashlib.sha256()
    robots = setup.SHIPPED
    for path in sorted([*GENERATOR.rglob("*.py"), *robots.rglob("*.yaml"), *robots.rglob("*.urdf")]):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def leave_interrupts_to_the_parent():
    """For worker processes: Ctrl-C ends the parent, and with it them."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def prepare(family, seed, folder, digest):
    """The case's truth; made anew unless the folder holds it, complete, from this generator."""
    mark = folder / "generator"
    if not mark.is_file() or mark.read_text() != digest:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        case.write(family, seed, folder)
        mark.write_text(digest)
    return json.loads((folder / "truth.json").read_text())


def command(tool, folder, truth, out):
    words = [str(tool), "diagnose", "--model", str(folder / "robot.yaml")]
    for name in truth["recordings"]:
        words += ["--recording", str(folder / name)]
    if truth["holdout"]:
        words += ["--holdout", str(folder / truth["holdout"])]
    return words + ["--out", str(out)]


@dataclasses.dataclass
class Trial:
    """A run to be made: folder is the case's own, limit the tool's seconds."""

    tool: pathlib.Path
    family: str
    seed: int
    folder: pathlib.Path
    digest: str
    limit: float
    keep: bool


def run(trial):
    """judge.Result of a trial, or None where its seed gives no case."""
    tool, folder, limit = trial.tool, trial.folder, trial.limit
    try:
        truth = prepare(trial.family, trial.seed, folder, trial.digest)
    except case.NoCase:
        return None
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    begin = time.monotonic()
    try:
        done = subprocess.run(command(tool, folder, truth, out), capture_output=True, text=True,
                              timeout=limit, stdin=subprocess.DEVNULL)
        seconds = time.monotonic() - begin
        if done.returncode != 0:
            said = done.stderr.strip().splitlines()
            raise answer.Malformed(f"exit {done.returncode}: {said[-1] if said else ''}")
        result = judge.judge(truth, answer.parse((out / "diagnosis.json").read_text()), seconds)
    except subprocess.TimeoutExpired:
        result = judge.failed(truth, f"failed: no answer within {limit:g} s", limit)
    except (answer.Malformed, OSError) as error:
        result = judge.failed(truth, f"failed: {error}", time.monotonic() - begin)
    if not trial.keep:
        for path in folder.glob("*.csv"):
            path.unlink()
        (folder / "generator").unlink()
    return result
