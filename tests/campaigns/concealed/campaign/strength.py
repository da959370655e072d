"""How far an effect stands out of the sensors' noise."""

import numpy as np

from plant.sensors import noise_levels

from .paths import Arm

LOOKED_AT = 300  # rows
CHANNELS = {"xyz": "tcp_position", "tau": "joint_torque", "q_link": "joint_deflection"}


def shown(description, signals, groups):
    """Recording of a plant less its model's own, to first order, at some rows: {group: (rows, k)}. The
    difference of two of these, of a robot with an effect and without, is the effect's trace."""
    arm = Arm(description)
    first = 0 if signals.static else len(signals.time) // 8
    rows = np.unique(np.linspace(first, len(signals.time) - 1, LOOKED_AT).astype(int))
    q = (signals.q_meas if "q_meas" in groups else signals.q_cmd)[rows]
    wrench = signals.wrench[rows] * ("wrench" in groups)
    compliance = description.column("compliance")
    pull = np.empty((len(rows), 6))
    xyz = np.empty((len(rows), 3))
    for index in range(len(rows)):
        jacobian = arm.jacobian(q[index])
        pull[index] = jacobian.T @ wrench[index]
        xyz[index] = arm.place(q[index])[0] + jacobian[:3] @ (compliance * pull[index])
    return {"xyz": signals.xyz[rows] - xyz, "tau": signals.tau[rows] + pull,
            "q_link": signals.q_link[rows] - q}


def ratio(with_effect, without, sensors, groups, local=False):
    """Rms of the effect over the noise, in the column that shows it most; of what acts only now and
    then (local) over the fifth of the rows that show it most."""
    levels, best = noise_levels(sensors), 0.0
    for group in CHANNELS:
        if group in groups:
            trace = np.abs(with_effect[group] - without[group]) / levels[group]
            if local:
                trace = np.sort(trace, axis=0)[-max(1, len(trace) // 5):]
            best = max(best, float(np.sqrt((trace**2).mean(0)).max()))
    return best
