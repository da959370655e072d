"""One case, before its truth is known: diagnosed, and predicted by all others, in the sandbox."""

import dataclasses
import json
import os
import pathlib
import shutil
import sys
import tempfile

from rivals import contest, toolbox

from . import cases

PACKAGES = pathlib.Path(__file__).resolve().parents[1]
RIVALS = PACKAGES / "rivals"
MACHINES = PACKAGES.parent / "machines"  # how toolboxes are asked
ANSWER, LEARNED = "diagnosis.json", "updated_model.yaml"
SLACK = 30.0  # s, for simulations besides the rivals themselves


@dataclasses.dataclass
class Way:
    """How every case of a campaign is run."""

    tool: pathlib.Path
    sandbox: object  # sandbox.Sandbox
    limit: float  # s a diagnosis
    rivals: bool
    rival_limit: float  # s each


def needed_to_read(tool):
    """Folders that runs see besides the system: the tool, this Python, the rivals."""
    folders = [tool, pathlib.Path(sys.prefix), pathlib.Path(sys.base_prefix), RIVALS, MACHINES]
    if toolbox.is_asked():
        folders.append(pathlib.Path(os.environ[toolbox.PYTHON]).parents[1])
    return folders


def _keep(source, target):
    """Copies plain files only: a link out of the sandbox would be followed here, outside it."""
    target.mkdir(parents=True, exist_ok=True)
    if source.is_dir() and not source.is_symlink():
        for path in source.iterdir():
            if path.is_file() and not path.is_symlink():
                shutil.copyfile(path, target / path.name)


def _diagnose(way, trainings, work):
    words = [str(way.tool), "diagnose", "--model", "model/robot.yaml"]
    for name in trainings:
        words += ["--recording", name]
    return way.sandbox.run(words + ["--holdout", "holdout.csv", "--out", "out"], work, way.limit)


def _compete(way, trainings, work):
    words = [sys.executable, "-m", "rivals", "--tool", str(way.tool), "--model", "model/robot.yaml",
             "--holdout", "holdout.csv", "--untrained", "untrained.csv", "--out", "contest",
             "--limit", str(way.rival_limit)]
    for name in trainings:
        words += ["--train", name]
    learned = work / "out" / LEARNED
    if learned.is_file() and not learned.is_symlink():
        words += ["--learned", f"out/{LEARNED}"]
    if not way.rivals:
        words.append("--models-only")
    methods = len(contest.methods(True, way.rivals))
    return way.sandbox.run(words, work, methods * way.rival_limit + SLACK,
                           {"PYTHONPATH": f"{PACKAGES}:{PACKAGES.parent}"} | toolbox.environment())


def run(way, case, answers):
    """Leaves in the folder answers: what the tool wrote, run.json (how it ended), contest/ (a file
    for each method), contest.json (how that ended). Raises sandbox.Stopped."""
    trainings = [path.name for path in cases.trainings(case)]
    with tempfile.TemporaryDirectory(prefix="case-") as folder:
        work = pathlib.Path(folder)
        shutil.copytree(case / "model", work / "model")
        for name in [*trainings, "holdout.csv"]:
            shutil.copyfile(case / name, work / name)
        diagnosed = _diagnose(way, trainings, work)
        _keep(work / "out", answers)
        # Only now: the region that nobody was trained on.
        shutil.copyfile(case / "untrained.csv", work / "untrained.csv")
        contest = _compete(way, trainings, work)
        _keep(work / "contest", answers / "contest")
    for name, done in (("run.json", diagnosed), ("contest.json", contest)):
        said = {"code": done.code, "seconds": round(done.seconds, 2), "last_words": done.last_words}
        (answers / name).write_text(json.dumps(said) + "\n")
