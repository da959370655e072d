"""Pictures of the TX40's diagnosis."""

from .. import plot


def draw(trial, folder):
    for joint in (1, 5):
        plot.torque_error(folder / f"joint_{joint}.png", trial.outcomes["filtered"], joint,
                          f"TX40, joint {joint}, held-out part")
