"""Pictures of the friction damper's diagnosis."""

from .. import plot


def draw(trial, folder):
    outcome = trial.outcomes["force"]
    travel = 1e3 * outcome.measured["q_meas_1"]
    plot.draw(folder / "loop.png", "Friction damper, held-out run", "mm", "kN", [
        plot.Curve("measured", travel, 1e-3 * outcome.measured["tau_1"], plot.GREY),
        plot.Curve("with what the diagnosis found", travel, 1e-3 * outcome.after["tau_1"],
                   plot.BLUE)])
    plot.torque_error(folder / "force.png", outcome, 1, "Friction damper, held-out run", "N")
