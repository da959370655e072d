"""Pictures of the TIAGo's diagnosis."""

from .. import plot


def draw(trial, folder):
    for joint in (2, 3):
        plot.missing_torque_over_speed(
            folder / f"joint_{joint}.png", trial.outcomes["torques"], joint,
            f"TIAGo, joint {joint}, held-out part")
