"""What foreign physics is: an effect that also says how a right answer may name it."""

import dataclasses

import numpy as np

from plant.effects.base import Effect


@dataclasses.dataclass
class Seen:
    """What a law is driven by, at the rows of a motion or of a load test."""

    time: np.ndarray  # (n,) s
    q: np.ndarray  # (n, 6) rad, motors
    v: np.ndarray  # (n, 6) rad/s
    a: np.ndarray  # (n, 6) rad/s²
    load: np.ndarray  # (n, 6) N·m that winds the springs up

    def of(self, name, joint):
        """(n,) of a joint, 1 to 6."""
        return getattr(self, name)[:, int(joint) - 1]


class Foreign(Effect):
    """Physics outside the catalogue. Besides `begin` and `sense`, it may act as the four hooks below,
    which do nothing unless they are overridden.

    exists  whether it is a law of signals that are recorded
    undone  whether a command can undo what it does to the tool
    kin     catalogue effects that say the same at the same joint, and are no wrong name: `effect`, or
            `effect/form` where only that form does
    begins  whether it begins within a recording: its kin must say when
    """

    exists = True
    undone = False
    kin = ()
    begins = False

    def driven(self, motion):
        """The Motion that a commanded one becomes: servos follow what their encoders show."""
        return motion

    def extra(self, seen):
        """(n,) N·m that the joint's drive gives besides."""
        return 0.0

    def angle(self, seen):
        """(n,) rad by which the joint's link stands elsewhere."""
        return 0.0

    def moved(self, seen, place):
        """(n, 3) m: where the TCP stands in place of `place`."""
        return place

    def places(self):
        """[(place, joint or axis or None), …] of a law that names it rightly."""
        raise NotImplementedError

    def laws(self):
        """Entries of robot.yaml's effects that say it in full, or none where its formulas cannot."""
        return []


def law(place, formula, *, joint=None, axis=None, **values):
    """One such entry."""
    where = {"joint": joint, "axis": axis}
    return {"effect": "law", "place": place,
            **{key: value for key, value in where.items() if value is not None},
            "formula": formula, **{name: float(value) for name, value in values.items()}}


def lagged(time, values, constant):
    """(n,) that follows values with a first-order lag (s), which begins where they do."""
    found, keep = values.astype(float).copy(), np.exp(-np.diff(time) / constant)
    for row in range(1, len(time)):
        found[row] = values[row] + (found[row - 1] - values[row]) * keep[row - 1]
    return found
