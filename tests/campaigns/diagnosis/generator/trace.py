"""Trace of an effect in a recording: measurement minus what the nominal model predicts from the
recording's own encoders and wrench, without noise."""

import numpy as np

from . import machine as physics

CHANNELS = {"xyz": "tcp_position", "tau": "joint_torque", "q_link": "joint_deflection"}
ROWS = 160  # looked at in each recording


def channels_of(take):
    return [group for group in CHANNELS if group in take.columns]


def spread_rows(take):
    """Whole sample numbers spread evenly over the recording."""
    first, last = np.ceil(take.rows[0]), np.floor(take.rows[-1])
    return np.unique(np.linspace(first, last, min(int(last - first) + 1, ROWS)).astype(int))


def residual(robot, machine, take, rows):
    """{group: (rows, columns)} of truth less prediction by the model `robot`."""
    groups = channels_of(take)
    truth = physics.measure(machine, take.drive, groups + ["wrench"], rows)
    source = machine if "q_meas" in take.columns else physics.nominal(robot)  # else the command is fed
    predicted = _prediction(robot, source, take, rows, truth["wrench"])
    found = {group: truth[group] - predicted[group] for group in groups}
    if "q_link" in groups and "q_meas" not in take.columns:
        found.pop("q_link")  # wind-up needs the motor's encoder
    return found


def _prediction(robot, source, take, rows, wrench):
    """Prediction of the model; kept for the next effect that changes neither encoders nor wrench."""
    model, groups = physics.nominal(robot), channels_of(take)
    plain = not (source.lag.any() or source.sensor or "wrench" in source.late)
    key = (id(robot), len(rows), rows[-1])
    if plain and key in take.drive.predictions:
        return take.drive.predictions[key]
    state = physics.at(physics.motors(source, take.drive), rows)
    if "wrench" in take.columns:
        state.wrench = wrench
    predicted = physics.predict(model, state, groups)
    if plain:
        take.drive.predictions[key] = predicted
    return predicted


def stack(traces, levels, quality):
    """The traces of all takes, [residual(...)], in units of noise, as one vector."""
    parts = []
    for trace in traces:
        for group, values in trace.items():
            keep = quality.link_encoders if group == "q_link" else slice(None)
            parts.append((values / levels[group])[:, keep].ravel())
    return np.concatenate(parts)


def difference(robot, machine, takes, levels, quality):
    traces = [residual(robot, machine, take, spread_rows(take)) for take in takes]
    return stack(traces, levels, quality)
