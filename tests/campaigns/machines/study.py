"""Studies of machines: their input, their outcome, and their goals."""

import dataclasses
import json
import math
import pathlib

import numpy as np

from .tables import columns_of

# Each channel of a diagnosis, the columns that it compares, and their unit.
CHANNELS = {"tcp_position": ("xyz", "m"), "joint_torque": ("tau", "N·m"),
            "joint_deflection": ("q_link", "rad")}

DRY_FRICTION = ("coulomb_friction", "friction_hysteresis")  # which stay at any speed
FRICTION = (*DRY_FRICTION, "stribeck_friction", "viscous_friction")


class NoAnswer(Exception):
    """The command failed or its answer is not what it should be."""


@dataclasses.dataclass
class Experiment:
    """One diagnosis of a machine; paths of its files."""

    name: str
    model: pathlib.Path
    recordings: list
    holdout: pathlib.Path


@dataclasses.dataclass
class Finding:
    """parameters: {name: (value, standard deviation or None, unit)}."""

    effect: str
    joint: int | None
    parameters: dict
    statement: str

    @property
    def name(self):
        return _place(self.effect, self.joint)

    def __str__(self):
        return f"{self.name} ({', '.join(map(_parameter, self.parameters.items()))})"


def names(findings):
    """For a person, in their order."""
    return ", ".join(finding.name for finding in findings) or "nothing"


def _place(effect, joint):
    return effect + (f" of joint {joint}" if joint else "")


def _parameter(item):
    name, (value, deviation, unit) = item
    spread = "" if deviation is None else f" ± {deviation:.2g}"
    return f"{name} {value:.4g}{spread}{'' if unit == '1' else ' ' + unit}"


@dataclasses.dataclass
class Answer:
    """diagnosis.json. reason: why something stays unexplained, or empty; nearest: what comes near;
    below_hz: how fast a torque the angles can tell of, or None where any."""

    verdict: str
    findings: list
    reason: str
    nearest: list
    below_hz: float = None

    def named(self, effects, joint=None):
        """Findings that are one of these effects (at that joint)."""
        return [finding for finding in self.findings if finding.effect in effects
                and joint in (None, finding.joint)]


def parse(text):
    """diagnosis.json's text -> Answer. Raises NoAnswer."""
    try:
        answer = json.loads(text)
        findings = [
            Finding(each["effect"], each["joint"],
                    {name: (entry["value"], entry["std"], entry["unit"])
                     for name, entry in each["parameters"].items()}, each["statement"])
            for each in answer["findings"]]
        left = answer["unexplained"] or {}
        return Answer(answer["verdict"], findings, left.get("reason", ""),
                      [_place(each["effect"], each["joint"]) for each in left.get("nearest", [])],
                      (answer.get("joint_torque_in_band") or {}).get("below_hz"))
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise NoAnswer(f"diagnosis.json is not as it should be: {error!r}") from error


@dataclasses.dataclass
class Outcome:
    """An experiment's answer, and its held-out recording as measured and as simulated with the
    model before and after: {column: (n,)}. updated_model: a path; seconds: of a processor, or
    not-a-number where nobody measured them."""

    experiment: Experiment
    answer: Answer
    updated_model: pathlib.Path
    measured: dict
    before: dict
    after: dict
    seconds: float = math.nan

    def errors(self, simulated, group):
        """Measured less simulated, held out: (n, columns of the group), not-a-number where
        unknown."""
        return np.column_stack([self.measured[name] - simulated[name]
                                for name in columns_of(self.measured, group)])

    def signal(self, group):
        """The signal that an error is compared with: torques as they are; for positions the nominal
        model's error."""
        if group == "tau":
            return np.column_stack([self.measured[name]
                                    for name in columns_of(self.measured, group)])
        return self.errors(self.before, group)

    def groups(self):
        """The compared groups of columns with their units."""
        return [(group, unit) for group, unit in CHANNELS.values()
                if any(np.isfinite(self.measured[name]).any()
                       for name in columns_of(self.measured, group))]


@dataclasses.dataclass
class Trial:
    """Material for a machine's goals and pictures: its outcomes by name, the command that
    made them, and the folder of the published files."""

    outcomes: dict
    tool: object
    data: pathlib.Path


@dataclasses.dataclass
class Goal:
    """text: what was to be reached; found: what was, in numbers."""

    text: str
    reached: bool
    found: str


def rms(values):
    return float(np.sqrt(np.nanmean(np.square(values))))


def mean_norm(errors):
    """Mean length of the rows of errors (n, 3)."""
    return float(np.nanmean(np.linalg.norm(errors, axis=1)))


def relative(errors, signal):
    """Root mean square of the errors in that of the signal, where both are known."""
    return rms(errors) / rms(np.where(np.isfinite(errors), signal, np.nan))


def speed_of(recording, joint):
    """Speed (n,) rad/s of a joint of a recording, by differences of its motor-side angle."""
    return np.gradient(recording[f"q_meas_{joint}"], recording["t"])
