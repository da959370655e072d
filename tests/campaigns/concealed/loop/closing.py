"""Closes the loop of a case: new tables from the diagnosed model, the core over the program tick by
tick, and the concealed plant again."""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from campaign import case as campaign_case
from rivals.recording import read

from . import milling

TOLERANCE = "1e-5"  # m, of the tables
ORIENTATION = "1e-4"  # rad
LIMIT = 300.0  # s a command


class Failed(Exception):
    """A command of the tool refused; says which and why."""


def pick(truths):
    """The first case of every concealed effect that is alone: {case: effect}."""
    found = {}
    for name in sorted(truths):
        effects = truths[name]["truth"]["effects"]
        if len(effects) == 1 and effects[0]["effect"] not in found.values():
            found[name] = effects[0]["effect"]
    return found


def _call(tool, *words):
    done = subprocess.run([str(tool), *map(str, words)], capture_output=True, text=True,
                          timeout=LIMIT, check=False)
    if done.returncode != 0:
        last = (done.stderr.strip() or done.stdout.strip()).splitlines()[-1:]
        raise Failed(f"flexcomp {words[0]}: exit {done.returncode}: {' '.join(last)}")
    return done.stdout


def _beside_model(nominal, diagnosed, folder):
    """The diagnosed model's copy, where it finds the URDF: in ../model, as where it was written."""
    shutil.copytree(nominal.parent, folder / "model")
    (folder / "answer").mkdir()
    return Path(shutil.copy(diagnosed, folder / "answer"))


class Loop:
    """A circle on a plant of a description, corrected by models. folder: for its files."""

    def __init__(self, tool, circle, description, folder):
        self.tool, self.circle, self.description, self.folder = tool, circle, description, folder

    def circularity(self, signals):
        """m, minimum zone, of where the TCP went."""
        path = self.folder / "course.csv"
        self.circle.write_course(signals, path)
        said = json.loads(_call(self.tool, "circularity", path, "--columns", self.circle.columns,
                                "--json"))
        return said["mzc"]["circularity"]

    def corrected(self, effects, signals, model):
        """Circularity with the program corrected by a model, of a plant with effects, whose signals
        without correction are known."""
        program, table = self.folder / "program.csv", self.folder / "table.fct"
        corrected = self.folder / "corrected.csv"
        self.circle.write_program(signals, program)
        _call(self.tool, "table", "--model", model, "--path", program, "--out", table,
              "--tolerance", TOLERANCE, "--orientation-tolerance", ORIENTATION)
        _call(self.tool, "compensate", "--model", model, "--table", table, "--path", program,
              "--out", corrected)
        correction = read(corrected).groups["q_cmd"] - read(program).groups["q_cmd"]
        return self.circularity(self.circle.run(self.description, effects, correction))


def measured(loop, effects, nominal, diagnosed):
    """Circularities (m) of a Loop's circle: uncorrected, nominal, diagnosed; without: of the plant
    without effects, corrected by the nominal model. nominal, diagnosed: paths of models, the second
    may be missing, then nothing was learnt. Raises Failed."""
    clean = loop.circle.run(loop.description, [])
    signals = loop.circle.run(loop.description, effects)
    result = {"uncorrected": loop.circularity(signals),
              "without": loop.corrected([], clean, nominal),
              "nominal": loop.corrected(effects, signals, nominal)}
    result["diagnosed"] = result["nominal"]
    if diagnosed.is_file():
        learned = _beside_model(nominal, diagnosed, loop.folder)
        result["diagnosed"] = loop.corrected(effects, signals, learned)
    return result


def close(tool, drawn, nominal, diagnosed):
    """What `measured` says of the plant of a drawn case of the campaign; or {"failed": why}."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        try:
            work = campaign_case.rebuild(drawn, folder / "case")
            circle = milling.draw(np.random.default_rng([*drawn.seed, 7]), work.description,
                                  work.center, work.rated, drawn.seed[0])
            return measured(Loop(tool, circle, work.description, folder), work.effects, nominal,
                            diagnosed)
        except (Failed, campaign_case.Unsuitable, FloatingPointError,
                subprocess.TimeoutExpired) as error:
            return {"failed": str(error)}
