"""Is a concealed effect there to be found, and could its trace be taken for another's?

The signal-to-noise rule: in the column that shows the effect most, the rms of its trace is at least
three times the noise's. Of effects that act only now and then (LOCAL) the tenth of the samples that
show them most must reach that, and the whole trace 30 standard deviations of the noise.

The distinction rule: of every other entry of the catalogue, at every joint, the best fit to the trace
leaves at least 8 standard deviations of the noise over all samples. If not, the recording does not
excite the effect and another is drawn; except that where the fit correlates with the trace by more
than 0.999, both say the same, and the other entry is listed as equivalent.
"""

import dataclasses

import numpy as np

from . import machine as physics
from .effects import CATALOGUE
from .trace import channels_of, difference, residual, spread_rows

LOCAL = ("stribeck_friction", "resonance")
FACTOR, LOCAL_TOTAL, REMAINDER, EQUIVALENT = 3.0, 30.0, 8.0, 0.999


@dataclasses.dataclass
class Likeness:
    """How well another effect explains a trace."""

    effect: str
    joint: int | None
    correlation: float  # of the trace with its best fit
    remainder: float  # standard deviations of the noise that the fit leaves, over all samples


def signal_to_noise(robot, machine, takes, levels, quality, local):
    """Ratio by the rule above, the best over groups and columns; 0 where the total is too small."""
    best = 0.0
    for group in channels_of(takes[0]):
        parts = [residual(robot, machine, take, spread_rows(take)) for take in takes]
        values = np.concatenate([part[group] for part in parts if group in part] or [np.zeros((1, 1))])
        if group == "q_link" and values.shape[1] == 6:
            values = values[:, quality.link_encoders]
            level = levels[group][quality.link_encoders]
        else:
            level = levels[group]
        ratio = np.abs(values) / level
        if local:
            count = sum(len(take.rows) for take in takes)
            total = np.sqrt((ratio**2).mean(0) * count)
            ratio = np.sort(ratio, axis=0)[-max(1, len(ratio) // 10):]
            ratio = np.where(total < LOCAL_TOTAL, 0, ratio)
        best = max(best, float(np.sqrt((ratio**2).mean(0)).max(initial=0.0)))
    return best


def _possible(effect, robot, takes):
    columns = takes[0].columns
    if not set(effect.groups) & set(columns):
        return False
    if effect.name.startswith("wrench") and "wrench" not in columns:
        return False
    if effect.name == "servo_lag" and "q_meas" in columns:
        return False
    return True


def rivals(robot, takes, levels, quality, scale):
    """(effect name, joint, [matrix of traces, a column a member]) of all entries of the catalogue."""
    for effect in CATALOGUE.values():
        if not _possible(effect, robot, takes):
            continue
        for joint in effect.joints:
            families = []
            for family in effect.probes(joint, robot, scale):
                columns = []
                for parameters in family:
                    machine = physics.nominal(robot.copy() if effect.alters_model else robot)
                    effect.apply(machine, joint, parameters)
                    columns.append(difference(robot, machine, takes, levels, quality))
                families.append(np.column_stack(columns))
            yield effect.name, joint, families


class Rivals:
    """The rivals, computed as they are asked for and kept: an unsuitable case often shows early."""

    def __init__(self, *arguments):
        self._coming = rivals(*arguments)
        self._kept = []

    def __iter__(self):
        yield from self._kept
        for rival in self._coming:
            self._kept.append(rival)
            yield rival


def explain(trace, matrix, samples):
    """Correlation of the trace with its least-squares fit by the matrix's columns, and what the fit
    leaves, scaled to all samples."""
    size = np.linalg.norm(matrix, axis=0)
    matrix = matrix[:, size > 1e-9] / size[size > 1e-9]
    whole = np.linalg.norm(trace)
    if matrix.shape[1] == 0 or whole == 0:
        return 0.0, whole * samples
    basis, weight, _ = np.linalg.svd(matrix, full_matrices=False)
    basis = basis[:, weight > 1e-9 * weight[0]]
    left = np.linalg.norm(trace - basis @ (basis.T @ trace))
    return float(np.sqrt(max(0.0, 1 - (left / whole) ** 2))), left * samples


def likenesses(trace, rival_list, takes, but=None):
    """Likeness of a trace to every rival, lazily; but: (effect, joint) to leave out."""
    looked_at = sum(len(spread_rows(take)) for take in takes)
    samples = np.sqrt(sum(len(take.rows) for take in takes) / looked_at)
    for name, joint, families in rival_list:
        if (name, joint) != but:
            correlation, remainder = max(explain(trace, matrix, samples) for matrix in families)
            yield Likeness(name, joint, correlation, float(remainder))


def likest_first(found):
    return sorted(found, key=lambda likeness: -likeness.correlation)
