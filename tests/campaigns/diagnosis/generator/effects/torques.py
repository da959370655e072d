"""Torques of the drives that the model lacks."""

import numpy as np

from .base import ALL_JOINTS, Effect, log_uniform, one, signed

TORQUE_KINDS = ("torque", "link", "mixed")


class CoulombFriction(Effect):
    name = "coulomb_friction"
    alters_model = True
    joints = ALL_JOINTS
    groups = ("tau",)
    kinds = TORQUE_KINDS
    units = {"torque": "N·m"}

    def draw(self, rng, joint, robot, scale):
        return {"torque": log_uniform(rng, 0.02, 0.3) * scale.torque[joint - 1]}

    def apply(self, machine, joint, parameters):
        machine.robot.coulomb[joint - 1] += parameters["torque"]

    def probes(self, joint, robot, scale):
        return [[{"torque": 0.1 * scale.torque[joint - 1]}]]


class ViscousFriction(Effect):
    name = "viscous_friction"
    alters_model = True
    joints = ALL_JOINTS
    groups = ("tau",)
    kinds = TORQUE_KINDS
    units = {"coefficient": "N·m·s/rad"}

    def draw(self, rng, joint, robot, scale):
        k = joint - 1
        return {"coefficient": log_uniform(rng, 0.03, 0.4) * scale.torque[k] / scale.speed[k]}

    def apply(self, machine, joint, parameters):
        machine.robot.viscous[joint - 1] += parameters["coefficient"]

    def probes(self, joint, robot, scale):
        k = joint - 1
        return [[{"coefficient": 0.1 * scale.torque[k] / scale.speed[k]}]]


class StribeckFriction(Effect):
    """Beyond Coulomb's: (static − Coulomb)·exp(−(speed/stribeck speed)²)."""

    name = "stribeck_friction"
    joints = ALL_JOINTS
    groups = ("tau",)
    kinds = TORQUE_KINDS
    hints = {"speed": "slow", "program": "fourier"}
    units = {"excess": "N·m", "speed": "rad/s"}

    def draw(self, rng, joint, robot, scale):
        return {"excess": log_uniform(rng, 0.06, 0.4) * scale.torque[joint - 1],
                "speed": log_uniform(rng, 0.06, 0.3) * scale.speed[joint - 1]}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)

        def friction(state):
            speed = state.velocity[:, k]
            falling = np.exp(-((speed / parameters["speed"]) ** 2))
            return parameters["excess"] * (falling * np.sign(speed))[:, None] * column

        machine.torque.append(friction)

    def probes(self, joint, robot, scale):
        return [[{"excess": 0.1 * scale.torque[joint - 1], "speed": share * scale.speed[joint - 1]}]
                for share in (0.06, 0.15, 0.3)]


class RotorInertia(Effect):
    name = "rotor_inertia"
    alters_model = True
    joints = ALL_JOINTS
    groups = ("tau",)
    kinds = ("torque", "link")
    units = {"inertia": "kg·m^2"}

    def draw(self, rng, joint, robot, scale):
        k = joint - 1
        return {"inertia": log_uniform(rng, 0.05, 0.5) * scale.torque[k] / scale.acceleration[k]}

    def apply(self, machine, joint, parameters):
        machine.robot.rotor[joint - 1] += parameters["inertia"]

    def probes(self, joint, robot, scale):
        k = joint - 1
        return [[{"inertia": 0.1 * scale.torque[k] / scale.acceleration[k]}]]


class TorqueRipple(Effect):
    """Cogging: a sinusoid of the joint angle of `order` periods a turn."""

    name = "torque_ripple"
    joints = ALL_JOINTS
    groups = ("tau",)
    kinds = TORQUE_KINDS
    units = {"amplitude": "N·m", "order": "1", "phase": "rad"}

    def draw(self, rng, joint, robot, scale):
        return {"amplitude": log_uniform(rng, 0.03, 0.2) * scale.torque[joint - 1],
                "order": float(np.round(rng.uniform(12, 120))),
                "phase": float(rng.uniform(0, 2 * np.pi))}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)

        def ripple(state):
            wave = np.sin(parameters["order"] * state.q[:, k] + parameters["phase"])
            return parameters["amplitude"] * wave[:, None] * column

        machine.torque.append(ripple)

    def probes(self, joint, robot, scale):
        return [[{"amplitude": 0.1 * scale.torque[joint - 1], "order": order, "phase": phase}
                 for phase in (0, np.pi / 2)] for order in (12.0, 24.0, 48.0, 96.0)]


class TorqueOffset(Effect):
    name = "torque_offset"
    joints = ALL_JOINTS
    groups = ("tau",)
    kinds = TORQUE_KINDS
    units = {"torque": "N·m"}

    def draw(self, rng, joint, robot, scale):
        return {"torque": signed(rng, 0.02, 0.3) * scale.torque[joint - 1]}

    def apply(self, machine, joint, parameters):
        _, column = one(machine, joint)
        machine.torque.append(
            lambda state: np.tile(parameters["torque"] * column, (len(state.time), 1)))

    def probes(self, joint, robot, scale):
        return [[{"torque": 0.1 * scale.torque[joint - 1]}]]


EFFECTS = (CoulombFriction(), ViscousFriction(), StribeckFriction(), RotorInertia(), TorqueRipple(),
           TorqueOffset())
