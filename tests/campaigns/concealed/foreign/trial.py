"""One case given to flexcomp in the sandbox, and what models leave of its recordings."""

import json
import pathlib
import resource
import shutil
import tempfile

import numpy as np
import yaml

from rivals import contest, refit, residual, simulation

from . import cases

KEPT = "diagnosis.json", "updated_model.yaml", "report.html"
JUDGED = "holdout", "untrained"


def _processor():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def diagnose(tool, options, box, limit, case, answers):
    """Leaves in the folder answers what the tool wrote, and run.json: how it ended. options: of
    `flexcomp diagnose`, beside the files."""
    with tempfile.TemporaryDirectory(prefix="foreign-") as folder:
        work = pathlib.Path(folder)
        shutil.copytree(case / "model", work / "model")
        for part in ("train", "holdout"):
            shutil.copyfile(case / f"{part}.csv", work / f"{part}.csv")
        before = _processor()
        done = box.run([str(tool), "diagnose", "--model", "model/robot.yaml", "--recording",
                        "train.csv", "--holdout", "holdout.csv", "--out", "out", *options],
                       work, limit)
        answers.mkdir(parents=True, exist_ok=True)
        for name in KEPT:
            path = work / "out" / name
            if path.is_file() and not path.is_symlink():
                shutil.copyfile(path, answers / name)
    said = {"code": done.code, "seconds": round(done.seconds, 2),
            "cpu": round(_processor() - before, 2), "last_words": done.last_words}
    (answers / "run.json").write_text(json.dumps(said) + "\n")


def excess(left, usable, noise):
    """What a model leaves beyond the noise: the mean square of each column over that of its noise,
    less one, summed. left, usable: {channel: (n, columns)}; noise: {channel: [columns]}."""
    total = 0.0
    for channel, values in left.items():
        counted = usable[channel] & np.isfinite(values)
        for column, rows, level in zip(values.T, counted.T, noise[channel]):
            if rows.any():
                total += float(np.mean(column[rows] ** 2)) / level**2 - 1
    return total


class Match:
    """A case's recordings against models; `noise` as in the truth."""

    def __init__(self, tool, case, floors, noise):
        self._tool, self._noise = tool, noise
        self._model = case / "model" / "robot.yaml"
        self._data = {part: contest.Data.load(case / f"{part}.csv", self._by(self._model))
                      for part in cases.PARTS}
        self._floors = floors

    def _by(self, model):
        return lambda path: simulation.simulate(self._tool, model, path)

    def nominal(self):
        """{part: excess}"""
        return {part: excess(self._data[part].residual, self._data[part].usable, self._noise)
                for part in JUDGED}

    def floor(self):
        """{part: excess}: what the nominal model leaves of the machine in which nothing is
        concealed."""
        found = {}
        for part in JUDGED:
            clean = contest.Data.load(self._floors / f"{part}.csv", self._by(self._model))
            found[part] = excess(clean.residual, clean.usable, self._noise)
        return found

    def of(self, model):
        """{part: excess} that a robot.yaml leaves."""
        found = {}
        for part in JUDGED:
            data = self._data[part]
            left = residual.residuals(data.recording.channels, self._by(model)(data.path))
            found[part] = excess(left, data.usable, self._noise)
        return found

    def refitted(self, scratch):
        """The same of the nominal model, its springs and friction fitted to the training."""
        return self.of(refit.learn(self._model, [self._data["train"]],
                                   lambda model, path: simulation.simulate(self._tool, model, path),
                                   scratch))

    def true(self, laws, scratch):
        """The same of the nominal model with laws (entries of robot.yaml's effects)."""
        text = yaml.safe_load(self._model.read_text())
        text["urdf"] = str(self._model.parent / text["urdf"])
        path = scratch / "true.yaml"
        path.write_text(yaml.safe_dump(text | {"effects": laws}, allow_unicode=True,
                                       sort_keys=False))
        return self.of(path)


def measure(tool, case, floors, answers, truth, rivals=True):
    """Writes errors.json: {method: {part: excess}}, and why a method has none. rivals: with the plain
    refit."""
    match = Match(tool, case, floors, truth["noise"])
    errors, failures = {"nominal": match.nominal(), "floor": match.floor()}, {}
    learned = answers / "updated_model.yaml"
    with tempfile.TemporaryDirectory() as folder:
        scratch = pathlib.Path(folder)
        ways = {"refit": lambda: match.refitted(scratch)} if rivals else {}
        if learned.is_file():
            # Its URDF is named relative to where the tool was given it.
            ways["flexcomp"] = lambda: match.of(_at_home(learned, case, scratch))
        if truth["foreign"] and truth["foreign"]["laws"] and not truth["known"]:
            ways["true law"] = lambda: match.true(truth["foreign"]["laws"], scratch)
        for method, way in ways.items():
            try:
                errors[method] = way()
            except (simulation.SimulationFailed, ValueError, np.linalg.LinAlgError) as error:
                failures[method] = str(error)
    (answers / "errors.json").write_text(json.dumps(
        {"errors": errors, "failures": failures}, indent=1) + "\n")


def _at_home(learned, case, scratch):
    text = yaml.safe_load(learned.read_text())
    text["urdf"] = str(case / "model" / pathlib.Path(text["urdf"]).name)
    path = scratch / "learned.yaml"
    path.write_text(yaml.safe_dump(text, allow_unicode=True, sort_keys=False))
    return path
