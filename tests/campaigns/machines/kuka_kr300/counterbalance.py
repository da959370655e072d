"""The counterbalance of axis 2: as published, and as a diagnosis has it."""

import numpy as np
import yaml

ANCHOR = 0.8, 0.2  # m, from the joint's axis to the cylinder's ends
FILLED_LENGTH = 0.6  # m, of the cylinder and rod at rest
PISTON, ROD = 0.055, 0.030  # m, diameters
AREA = np.pi / 4 * (PISTON**2 - ROD**2)
GAS_VOLUME = 0.00096  # m³, at rest
GAS_CONSTANT = 1.01 * 296.8 * 328 * 0.159  # J: mass, specific constant, temperature, as published
ZERO_ANGLE = np.radians(5.0)


def published_torque(q2):
    """Torque (n,) N·m that the counterbalance adds to the motor's of axis 2 at angles (n,) in rad.

    A gas spring between a point of the base and one of the link (the recordings' authors): stroke,
    pressure of an ideal gas, lever arm.
    """
    far, near = ANCHOR
    lean = q2 + ZERO_ANGLE
    stroke = np.sqrt(far**2 + near**2 - 2 * far * near * np.cos(lean)) - (far - near)
    pressure = GAS_CONSTANT / (GAS_VOLUME - stroke * AREA)
    return np.sin(lean) * far * near / (stroke + FILLED_LENGTH) * pressure * AREA


def found_torque(trial, folder):
    """The same of the updated model, over the held-out recording; None where it has no
    counterbalance.

    It is what the simulated torque changes by if of all that was learnt only the counterbalance is
    kept.
    """
    outcome = trial.outcomes["torques"]
    learnt = yaml.safe_load(outcome.updated_model.read_text()).get("effects", [])
    kept = [effect for effect in learnt
            if effect["effect"] == "gravity_compensator" and effect.get("joint") == 2]
    if not kept:
        return None
    model = outcome.experiment.model.parent / "counterbalance_only.yaml"
    nominal = yaml.safe_load(outcome.experiment.model.read_text())
    model.write_text(yaml.safe_dump(nominal | {"effects": kept}, sort_keys=False))
    alone = trial.tool.simulate(model, outcome.experiment.holdout,
                                folder / "counterbalance_only.csv")
    return alone["tau_2"] - outcome.before["tau_2"]
