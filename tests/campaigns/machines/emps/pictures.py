"""Pictures of EMPS's diagnosis."""

from .. import plot


def draw(trial, folder):
    outcome = trial.outcomes["force"]
    plot.torque_error(folder / "force.png", outcome, 1, "EMPS, held-out run with the square wave",
                      "N")
    plot.missing_torque_over_speed(folder / "friction.png", outcome, 1,
                                   "EMPS: what inertia leaves of the force, held-out run",
                                   "m/s", "N")
