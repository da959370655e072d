"""Pictures of the other Panda's diagnosis."""

from .. import plot


def draw(trial, folder):
    plot.missing_torque_over_speed(
        folder / "joint_1.png", trial.outcomes["torques"], 1, "The other Panda, joint 1, held-out part")
