"""A case given to flexcomp in the sandbox, and how its updated model predicts."""

import json
import pathlib
import resource
import shutil
import tempfile

from rivals import recording

from . import cases

GIVEN = "robot.yaml", "robot.urdf", "train.csv", "holdout.csv"
KEPT = "diagnosis.json", "updated_model.yaml", "report.html"
SIMULATION = 120.0  # s


def _cpu():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _simulated(tool, box, work, model, part, group):
    out = f"{part}.simulated.csv"
    done = box.run([str(tool), "simulate", "--model", model, "--recording", f"{part}.csv",
                    "--out", out], work, SIMULATION)
    if done.code != 0:
        return None, done.last_words or f"exit {done.code}"
    return recording.read(work / out).groups.get(group), ""


def run(tool, box, limit, kind, case, answers):
    """Diagnoses a case and predicts with what came of it; leaves everything in the folder answers.
    Returns {"code", "seconds", "cpu", "last_words", "errors": {model: {part: error}}, "failures"}.
    """
    with tempfile.TemporaryDirectory(prefix="many-") as folder:
        work = pathlib.Path(folder)
        for name in GIVEN:
            shutil.copyfile(case / name, work / name)
        before = _cpu()
        done = box.run([str(tool), "diagnose", "--model", "robot.yaml", "--recording", "train.csv",
                        "--holdout", "holdout.csv", "--out", "out"], work, limit)
        cpu = _cpu() - before
        answers.mkdir(parents=True, exist_ok=True)
        for name in KEPT:
            if (work / "out" / name).is_file():
                shutil.copyfile(work / "out" / name, answers / name)
        # Only now: where nobody was trained.
        shutil.copyfile(case / "untrained.csv", work / "untrained.csv")
        found = {"code": done.code, "seconds": done.seconds, "cpu": cpu,
                 "last_words": done.last_words, "errors": {}, "failures": []}
        models = {"nominal": "robot.yaml", "flexcomp": "out/updated_model.yaml"}
        for name, model in models.items():
            found["errors"][name] = {}
            for part in cases.PARTS:
                read = recording.read(work / f"{part}.csv")
                group = cases.GROUP[kind]
                values, why_not = _simulated(tool, box, work, model, part, group)
                if values is None or values.shape != read.groups[group].shape:
                    found["failures"].append(f"{name}, {part}: {why_not or 'no such columns'}")
                else:
                    found["errors"][name][part] = cases.error(kind, read, values)
    (answers / "run.json").write_text(json.dumps(found) + "\n")
    return found
