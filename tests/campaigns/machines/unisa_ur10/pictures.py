"""Pictures of the UR10's diagnosis."""

from .. import plot


def draw(trial, folder):
    for joint in (1, 3):
        plot.missing_torque_over_speed(
            folder / f"joint_{joint}.png", trial.outcomes["torques"], joint,
            f"UR10, joint {joint}, held-out part")
