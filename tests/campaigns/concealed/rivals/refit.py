"""The plain way: the nominal model's own numbers, fitted by least squares.

Joint compliances from positions and deflections, viscous and Coulomb friction of each joint from
torques. Both enter the simulation linearly (compliances, as long as they change little), so that
one simulation a parameter gives its column; the fitted model is then simulated anew, without that
approximation.
"""

import pathlib

import numpy as np
import yaml
from scipy.optimize import lsq_linear

from .features import thinned
from .residual import DEVIATION_OF_MEDIAN

ROWS = 3000  # of a recording
STEP = 0.1  # of a compliance, for its column
SMALLEST = 1e-8  # rad/(N·m), where the model's compliance is zero
SOFTEST, STIFFEST = 20.0, -0.99  # change of a compliance, in parts of it
KNOWN_TO = 1.0  # the same, one standard deviation: what a recording does not show stays as it is
FRICTION = ("viscous", "coulomb")


class Model:
    """A robot.yaml whose numbers can be changed."""

    def __init__(self, path):
        self._path = pathlib.Path(path).resolve()
        self._text = yaml.safe_load(self._path.read_text())
        self.joints = list(self._text["joints"])

    def of(self, key):
        """(6,) values of a key of the joints."""
        return np.array([float(self._text["joints"][joint].get(key, 0.0)) for joint in self.joints])

    def write(self, path, **values):
        """With other values (6,) for some keys of the joints."""
        text = self._text | {"urdf": str(self._path.parent / self._text["urdf"])}
        text["joints"] = {
            joint: entry | {key: float(each[k]) for key, each in values.items()}
            for k, (joint, entry) in enumerate(self._text["joints"].items())}
        path.write_text(yaml.safe_dump(text, sort_keys=False))
        return path


def noise_of(values, is_static):
    """Robust standard deviation of what changes from row to row (n, columns) -> one number."""
    differences = values if is_static else np.diff(values, axis=0) / np.sqrt(2)
    differences = differences[np.isfinite(differences)]
    typical = DEVIATION_OF_MEDIAN * np.median(np.abs(differences)) if differences.size else 0.0
    return typical or 1.0


def _compliances(model, trainings, simulate, scratch):
    """(6,) fitted, or None where no recording shows deflections."""
    nominal = model.of("compliance")
    unit = np.maximum(nominal, SMALLEST)
    columns, targets = [], []
    models = [model.write(scratch / f"softer_{k}.yaml", compliance=nominal + STEP * unit * one)
              for k, one in enumerate(np.eye(len(unit)))]
    for training in trainings:
        chosen = {channel: usable for channel, usable in training.usable.items()
                  if channel != "joint_torque"}
        if not chosen:
            continue
        changed = [simulate(path, training.path) for path in models]
        for channel, usable in chosen.items():
            target = training.residual[channel]
            scale = noise_of(target, training.recording.is_static)
            slopes = np.stack([(each[channel] - training.nominal[channel]) / STEP
                               for each in changed], axis=-1)
            good = usable & np.isfinite(slopes).all(-1)
            rows = thinned(np.flatnonzero(good.ravel()), 3 * ROWS)
            columns.append(slopes.reshape(-1, len(unit))[rows] / scale)
            targets.append(target.ravel()[rows] / scale)
    if not columns:
        return None
    columns.append(np.eye(len(unit)) / KNOWN_TO)
    targets.append(np.zeros(len(unit)))
    found = lsq_linear(np.concatenate(columns), np.concatenate(targets), (STIFFEST, SOFTEST))
    return nominal + found.x * unit


def _friction(model, trainings, simulate, scratch):
    """{key: (6,)} fitted, or nothing where no recording has torques."""
    trainings = [training for training in trainings if "joint_torque" in training.usable]
    if not trainings:
        return {}
    nominal = {key: model.of(key) for key in FRICTION}
    models = {key: model.write(scratch / f"more_{key}.yaml", **{key: nominal[key] + 1.0})
              for key in FRICTION}
    slopes = [[simulate(models[key], training.path)["joint_torque"]
               - training.nominal["joint_torque"] for key in FRICTION] for training in trainings]
    found = {key: values.copy() for key, values in nominal.items()}
    for joint in range(len(model.joints)):
        columns, targets = [], []
        for training, (viscous, coulomb) in zip(trainings, slopes):
            column = np.column_stack([viscous[:, joint], coulomb[:, joint]])
            good = training.usable["joint_torque"][:, joint] & np.isfinite(column).all(1)
            rows = thinned(np.flatnonzero(good), ROWS)
            columns.append(column[rows])
            targets.append(training.residual["joint_torque"][rows, joint])
        columns, targets = np.concatenate(columns), np.concatenate(targets)
        if len(targets) <= len(FRICTION) or not columns.any():
            continue
        least = [-nominal[key][joint] - 1e-12 for key in FRICTION]
        change = lsq_linear(columns, targets, (least, np.inf)).x
        for key, value in zip(FRICTION, change):
            found[key][joint] = max(0.0, nominal[key][joint] + value)
    return found


def learn(model_path, trainings, simulate, scratch):
    """Fits; returns the path of the fitted model, written into the folder scratch.

    trainings: of contest.Data; simulate: (model, recording's path) -> {channel: values}."""
    model = Model(model_path)
    values = _friction(model, trainings, simulate, scratch)
    compliance = _compliances(model, trainings, simulate, scratch)
    if compliance is not None:
        values["compliance"] = compliance
    return model.write(scratch / "refit.yaml", **values)
