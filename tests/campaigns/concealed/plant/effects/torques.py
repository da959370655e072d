"""Torques of the drives."""

import numpy as np

from .base import Effect

SMOOTH_SPEED = 3e-3  # rad/s over which slow friction turns round


class CoulombFriction(Effect):
    """torque: N·m more of the engine's dry friction on the motor."""

    name = "coulomb_friction"

    def alter(self, description):
        description.joints[self.joint - 1].coulomb += self.parameters["torque"]


class ViscousFriction(Effect):
    """coefficient: N·m·s/rad more."""

    name = "viscous_friction"

    def alter(self, description):
        description.joints[self.joint - 1].viscous += self.parameters["coefficient"]


class RotorInertia(Effect):
    """inertia: kg·m² more, joint side."""

    name = "rotor_inertia"

    def alter(self, description):
        description.joints[self.joint - 1].rotor_inertia += self.parameters["inertia"]


class StribeckFriction(Effect):
    """excess: N·m beyond dry friction at standstill, falling as exp(-(speed/`speed`)²)
    (Armstrong-Hélouvry, Dupont and Canudas de Wit 1994)."""

    name = "stribeck_friction"

    def prepare(self, simulation):
        self._dof = simulation.motor_dof[self.joint - 1]

    def step(self, simulation, row):
        speed = simulation.data.qvel[self._dof]
        falling = np.exp(-((speed / self.parameters["speed"]) ** 2))
        friction = self.parameters["excess"] * falling * np.tanh(speed / SMOOTH_SPEED)
        simulation.data.qfrc_applied[self._dof] -= friction


class TorqueRipple(Effect):
    """The motor must give amplitude·sin(order·q + phase) more."""

    name = "torque_ripple"

    def prepare(self, simulation):
        self._dof = simulation.motor_dof[self.joint - 1]
        self._motor = simulation.motor[self.joint - 1]

    def step(self, simulation, row):
        wave = self.parameters
        angle = wave["order"] * simulation.data.qpos[self._motor] + wave["phase"]
        simulation.data.qfrc_applied[self._dof] -= wave["amplitude"] * np.sin(angle)


class TorqueOffset(Effect):
    """torque: N·m that the current sensor reads at none."""

    name = "torque_offset"

    def sense(self, signals, description):
        signals.tau[:, self.joint - 1] += self.parameters["torque"]
