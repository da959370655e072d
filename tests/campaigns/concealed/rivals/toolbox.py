"""Identification packages that fit every number of a model to torques: FIGAROH and mujoco.sysid.

They run as on the recordings of real machines (`machines.rivals`), in a Python of their own. Neither knows
of a wrench at the tool, so that its share of the torques, by the nominal model, is taken out before.
"""

import dataclasses
import os
import pathlib
import subprocess

import numpy as np
from machines.tables import read_recording, write_recording

PYTHON = "FLEXCOMP_RIVALS_PYTHON"
MODULES = {"FIGAROH": "figaroh_identification", "mujoco.sysid": "mujoco_sysid"}
CHANNEL = "joint_torque"
CAMPAIGNS = pathlib.Path(__file__).resolve().parents[2]


def environment():
    """What a run needs that is to ask them; nothing where nobody asks."""
    return {PYTHON: os.environ[PYTHON]} if is_asked() else {}


def is_asked():
    """Whether the environment names their Python."""
    return bool(os.environ.get(PYTHON))


def _share_of_wrench(data, simulate_nominal, scratch):
    """(n, joints) of torque."""
    if "wrench" not in data.recording.groups:
        return np.zeros_like(data.nominal[CHANNEL])
    without = {name: values for name, values in data.recording.groups.items()
               if name in ("q_meas", "q_cmd", "tau")}
    path = write_recording(scratch / "no_wrench.csv", data.recording.time, **without)
    return data.nominal[CHANNEL] - simulate_nominal(path)[CHANNEL]


def _usable_rows(data):
    """Rows (n,) whose angles are there; the filters of both fill what lies between them."""
    return np.isfinite(data.recording.angles).all(axis=1)


def _write(path, data, share, rows, torque):
    write_recording(path, data.recording.time[rows], q_meas=data.recording.angles[rows],
                    tau=(torque - share)[rows])
    return path


def _training(path, data, share):
    rows = _usable_rows(data) & data.usable[CHANNEL].all(axis=1)
    return _write(path, data, share, rows, data.residual[CHANNEL] + data.nominal[CHANNEL])


def _judged(path, data, share):
    # Its torques are nobody's to learn from: the nominal ones stand in for them.
    return _write(path, data, share, _usable_rows(data), data.nominal[CHANNEL])


def _ask(name, model, trainings, judged, out):
    words = [os.environ[PYTHON], "-W", "ignore", "-m", "machines.rivals", MODULES[name], "--model", model,
             "--holdout", judged, "--out", out]
    for path in trainings:
        words += ["--recording", path]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True, check=False,
                          env=os.environ | {"PYTHONPATH": str(CAMPAIGNS)})
    if done.returncode != 0:
        raise ValueError((done.stderr.strip().splitlines() or ["says nothing"])[-1])
    return read_recording(out)


@dataclasses.dataclass
class Toolbox:
    """name: of MODULES; simulate_nominal: path of a recording -> {channel: values}; scratch: a folder."""

    name: str
    model: pathlib.Path
    simulate_nominal: object
    scratch: pathlib.Path

    def predictions(self, trainings, judged):
        """{name of a judged recording: torques (n, joints)}, NaN where angles are missing. trainings, judged's
        values: of contest.Data. Raises ValueError where the package has nothing to learn from, or fails."""
        trainings = [data for data in trainings
                     if CHANNEL in data.residual and not data.recording.is_static]
        if not trainings:
            raise ValueError("identifies torques along a motion, of which there are none")
        paths = [_training(self.scratch / f"train_{number}.csv", data, self._share(data))
                 for number, data in enumerate(trainings)]
        return {name: self._predicted(data, paths) for name, data in judged.items()
                if CHANNEL in data.residual}

    def _share(self, data):
        return _share_of_wrench(data, self.simulate_nominal, self.scratch)

    def _predicted(self, data, trainings):
        share = self._share(data)
        judged = _judged(self.scratch / "judged.csv", data, share)
        found = _ask(self.name, self.model, trainings, judged, self.scratch / "answer.csv")
        torque = np.full_like(share, np.nan)
        torque[_usable_rows(data)] = np.column_stack(
            [found[f"tau_{joint}"] for joint in range(1, share.shape[1] + 1)])
        return torque + share
