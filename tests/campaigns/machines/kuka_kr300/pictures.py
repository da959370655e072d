"""Pictures of the KR 300's diagnosis."""

import numpy as np

from .. import plot
from . import counterbalance


def draw(trial, folder):
    torques, encoders = trial.outcomes["torques"], trial.outcomes["encoders"]
    plot.torque_error(folder / "axis_2.png", torques, 2, "KR 300, axis 2, held-out motion A")
    q2 = torques.measured["q_meas_2"]
    curves = [plot.Curve("published formula", np.degrees(q2), counterbalance.published_torque(q2),
                         plot.GREY)]
    found = counterbalance.found_torque(trial, torques.updated_model.parent)
    if found is not None:
        curves.append(plot.Curve("what the diagnosis found", np.degrees(q2), found, plot.BLUE))
    plot.draw(folder / "counterbalance.png", "What the counterbalance adds to the torque of axis 2",
              "axis 2, degrees", "N·m", curves)
    time = encoders.measured["t"]
    difference = {label: 1e6 * (table["q_link_2"] - encoders.measured["q_meas_2"])
                  for label, table in (("measured", encoders.measured), ("after", encoders.after))}
    curves = [
        plot.Curve("measured", time, difference["measured"], plot.GREY),
        plot.Curve("with what the diagnosis found", time, difference["after"], plot.BLUE)]
    plot.draw(folder / "link_encoder_2.png",
              "Axis 2: link-side less motor-side angle, held-out motion A", "s", "µrad", curves)
