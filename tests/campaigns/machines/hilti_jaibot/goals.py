"""Goals for the JaiBot."""

import numpy as np

from ..study import Goal, mean_norm, names
from . import reader, tilt

MICRO = 1e6


def judge(trial):
    return [_below_the_arm(trial, site) for site in reader.SITES]


def _below_the_arm(trial, site):
    outcome = trial.outcomes[site]
    found = outcome.answer.named(("base_compliance",))
    before, after = (mean_norm(outcome.errors(simulated, "xyz")) * 1e3
                     for simulated in (outcome.before, outcome.after))
    witness = "; ".join(f"{place} {_both(values)}"
                        for place, values in tilt.springs(trial.data, site).items())
    return Goal(f"{site}: what gives way is located below the arm, in base and column", bool(found),
                f"{names(found)}; mean error of the held-out poses {before:.2f} to {after:.2f} mm "
                f"(accelerometers, about x and y: {witness} µrad/(N·m))")


def _both(values):
    return " and ".join(f"{value * MICRO:.1f}" for value in np.asarray(values))
