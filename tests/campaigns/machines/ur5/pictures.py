"""Pictures of the UR5's diagnosis."""

from .. import plot


def draw(trial, folder):
    plot.sorted_errors(folder / "errors.png", trial.outcomes["positions"], "UR5, held-out poses")
