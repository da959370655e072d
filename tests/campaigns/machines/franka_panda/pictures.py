"""Pictures of the Panda's diagnosis."""

from .. import plot


def draw(trial, folder):
    for joint in (4, 5):
        plot.missing_torque_over_speed(
            folder / f"joint_{joint}.png", trial.outcomes["torques"], joint,
            f"Panda, joint {joint}, held-out quarter")
