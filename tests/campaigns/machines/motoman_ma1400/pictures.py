"""Pictures of the Motoman's diagnosis."""

from .. import plot
from .reader import ARMS


def draw(trial, folder):
    for arm in ARMS:
        plot.sorted_errors(folder / f"errors_{arm}.png", trial.outcomes[arm],
                           f"Motoman MA1400, {arm} arm, held-out poses")
