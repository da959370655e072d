"""Goals for the Motoman."""

from ..study import Goal, mean_norm, names
from ..ur5.goals import GEOMETRY
from .reader import ARMS

LARGEST_ERROR = {"right": 65, "left": 79}  # µm: a plain calibration of all frames and 5 %


def _goals(arm, outcome):
    before, after = (mean_norm(outcome.errors(simulated, "xyz")) * 1e6
                     for simulated in (outcome.before, outcome.after))
    found = outcome.answer.named(GEOMETRY)
    return [Goal(f"{arm} arm: geometry is named", bool(found), names(found)),
            Goal(f"{arm} arm: mean error of the held-out poses at most {LARGEST_ERROR[arm]} µm",
                 after <= LARGEST_ERROR[arm], f"{before:.0f} to {after:.0f} µm")]


def judge(trial):
    return [goal for arm in ARMS for goal in _goals(arm, trial.outcomes[arm])]
