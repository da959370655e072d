"""Pictures of the JaiBot's diagnosis."""

from .. import plot


def draw(trial, folder):
    for site, outcome in trial.outcomes.items():
        plot.sorted_errors(folder / f"errors_{site}.png", outcome,
                           f"JaiBot, held-out poses, {site}")
