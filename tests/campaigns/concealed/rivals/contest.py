"""All ways to predict on one case: nominal model, diagnosed model, plain refit, black boxes, toolboxes."""

import dataclasses
import functools
import importlib
import pathlib
import tempfile

import numpy as np

from . import recording, residual, simulation, toolbox

NOMINAL, DIAGNOSED, REFIT = "nominal", "flexcomp", "refit"
MODELS = (NOMINAL, DIAGNOSED)
# Modules, loaded when they are needed: their libraries take seconds to load.
BLACK_BOXES = {"PySINDy": "sindy", "boosting": "boosting", "Gaussian process": "gaussian_process"}
RIVALS = (REFIT, *BLACK_BOXES)
TOOLBOXES = tuple(toolbox.MODULES)  # only where the environment names their Python


def methods(learned, rivals):
    """Names of all that compete. learned: whether there is a diagnosed model; rivals: whether they are asked."""
    found = [NOMINAL, DIAGNOSED] if learned else [NOMINAL]
    if rivals:
        found += [*RIVALS, *(TOOLBOXES if toolbox.is_asked() else ())]
    return found


def _module(name):
    return importlib.import_module(f".{name}", __package__)


@dataclasses.dataclass
class Data:
    """A recording beside its nominal simulation."""

    path: pathlib.Path
    recording: recording.Recording
    nominal: dict  # channel -> (n, columns)
    residual: dict  # the same, measured − nominal
    usable: dict  # channel -> (n, columns) bool: the samples on which all are judged

    @classmethod
    def load(cls, path, simulate):
        read, nominal = recording.read(path), simulate(path)
        left = residual.residuals(read.channels, nominal)
        usable = {channel: residual.usable(values, read.is_static)
                  for channel, values in left.items()}
        return cls(path, read, nominal, left, usable)


class Contest:
    """One case: trainings, and by name ("holdout", "untrained") what all are judged on."""

    def __init__(self, tool, model, trainings, judged, learned=None):
        self._simulate = functools.partial(simulation.simulate, tool)
        self._model, self._learned = model, learned
        self.trainings = [self._load(path) for path in trainings]
        self.judged = {name: self._load(path) for name, path in judged.items()}

    def _load(self, path):
        return Data.load(path, functools.partial(self._simulate, self._model))

    def remainders(self, method):
        """{name of a judged recording: {channel: (n, columns)}}: what the method leaves."""
        if method == NOMINAL:
            return {name: data.residual for name, data in self.judged.items()}
        if method == DIAGNOSED:
            return self._left_by_model(self._learned)
        if method == REFIT:
            with tempfile.TemporaryDirectory() as scratch:
                return self._left_by_model(_module("refit").learn(
                    self._model, self.trainings, self._simulate, pathlib.Path(scratch)))
        if method in TOOLBOXES:
            return self._left_by_toolbox(method)
        return self._left_by_black_box(_module(BLACK_BOXES[method]).learn)

    def _left_by_model(self, model):
        return {name: residual.residuals(data.recording.channels, self._simulate(model, data.path))
                for name, data in self.judged.items()}

    def _left_by_toolbox(self, name):
        """Channels other than torques stay as the nominal model has them."""
        with tempfile.TemporaryDirectory() as scratch:
            box = toolbox.Toolbox(name, self._model, functools.partial(self._simulate, self._model),
                                  pathlib.Path(scratch))
            predicted = box.predictions(self.trainings, self.judged)
        left = {each: dict(data.residual) for each, data in self.judged.items()}
        for each, torque in predicted.items():
            left[each][toolbox.CHANNEL] = (
                self.judged[each].residual[toolbox.CHANNEL]
                + self.judged[each].nominal[toolbox.CHANNEL] - torque)
        return left

    def _left_by_black_box(self, learn):
        black_box = _module("black_box")
        left = {name: {} for name in self.judged}
        for channel in self.trainings[0].residual:
            predict = black_box.learnt(learn, self.trainings, channel)
            for name, data in self.judged.items():
                left[name][channel] = data.residual[channel] - predict(data.recording)
        return left

    def errors(self, remainders):
        """{name: {channel: {"rms", "stretches"}}} over the same samples for every method."""
        found = {}
        for name, left in remainders.items():
            found[name] = {}
            for channel, values in left.items():
                chosen = self.judged[name].usable[channel] & np.isfinite(values)
                found[name][channel] = {"rms": residual.rms(values, chosen),
                                        "stretches": residual.rms_by_stretch(values, chosen)}
        return found
