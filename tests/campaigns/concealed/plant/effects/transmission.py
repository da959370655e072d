"""Between motor and link."""

import dataclasses

import numpy as np

from ..assembly import HINGE, STEP, TINY_MASS, set_lump, stiff_friction
from .base import Effect

WELL_RESOLVED = 0.3  # rad: phase of an oscillation within one step of the engine
FREE_FLIGHT = 0.04  # the same, where one step's flight must be small against a gap


def resolved_inertia(stiffness, phase=WELL_RESOLVED):
    """The least inertia (kg·m²) that the engine's step resolves on a spring (N·m/rad)."""
    return stiffness * (STEP / phase) ** 2


class JointStiffness(Effect):
    """compliance_change: rad/(N·m) more than the model's."""

    name = "joint_stiffness"

    def alter(self, description):
        joint = description.joints[self.joint - 1]
        joint.compliance += self.parameters["compliance_change"]
        self.parameters["compliance"] = joint.compliance


class NonlinearStiffness(Effect):
    """Wind-up c τ + c3 τ³ under a torque τ, with c the model's; cubic_compliance: c3, rad/(N·m)³."""

    name = "nonlinear_stiffness"
    ITERATIONS = 6  # of Newton's method

    def prepare(self, simulation):
        name = f"spring_{self.joint}"
        self._qpos, self._dof = simulation.qpos(name), simulation.dof(name)
        self._stiffness = simulation.model.joint(name).stiffness[0]

    def torque(self, windup):
        """N·m of the spring at a wind-up (rad)."""
        linear, cubic = 1 / self._stiffness, self.parameters["cubic_compliance"]
        torque = windup / linear
        for _ in range(self.ITERATIONS):
            slope = max(linear + 3 * cubic * torque**2, 0.1 * linear)
            torque -= (linear * torque + cubic * torque**3 - windup) / slope
        return torque

    def step(self, simulation, row):
        windup = float(simulation.data.qpos[self._qpos])
        beyond = self.torque(windup) - self._stiffness * windup
        simulation.data.qfrc_applied[self._dof] -= beyond


class Backlash(Effect):
    """A hinge that is free between two stops, in series with the spring, dragged by its bearing.

    gap: rad from stop to stop. hold: N·m of the bearing's drag."""

    name = "backlash"

    def build(self, assembly):
        half = 0.5 * self.parameters["gap"]
        spring = assembly.spring(self.joint)
        spring.armature = resolved_inertia(spring.stiffness[0], FREE_FLIGHT)
        name = f"gap_{self.joint}"
        assembly.links[self.joint - 1].add_joint(
            name=name, type=HINGE, axis=spring.axis, range=[-half, half], limited=True,
            solref_limit=[2 * STEP, 1], solimp_limit=[0.9999, 0.9999, 1e-3, 0.5, 2],
            **stiff_friction(self.parameters["hold"]))
        assembly.turning[self.joint - 1].append(name)


class Hysteresis(Effect):
    """Jenkins elements beside the spring: each a spring in series with dry friction, between motor
    and link (Iwan 1966). Where all slide, the link lags behind the model's straight line of torque
    and deflection by `amplitude` (rad); `slip`: rad in the mean until they slide; yield_torque (N·m):
    integral of 1 - lag / amplitude over a load that rises from none."""

    name = "hysteresis"
    SLIPS = (0.5, 1.5)  # shares of the mean slip at which the elements begin to slide

    def build(self, assembly):
        joint, spring = self.joint, assembly.spring(self.joint)
        stiffness = spring.stiffness[0]
        total = self.parameters["amplitude"] * stiffness
        reach = self.parameters["slip"]
        # The lag is z(x) of its amplitude at a spring's deflection x, the load is K x + total z: the
        # integral of 1 - z over x is half the mean slip, that over z a half.
        self.parameters["yield_torque"] = 0.5 * (stiffness * reach + total)
        for number, share in enumerate(self.SLIPS):
            torque = total / len(self.SLIPS)
            branch = torque / (share * reach)
            slider = assembly.motors[joint - 1].add_body(name=f"slider_{joint}_{number}")
            set_lump(slider, TINY_MASS, 1e-3 * TINY_MASS)
            inertia = resolved_inertia(branch)
            slider.add_joint(name=f"slider_{joint}_{number}", type=HINGE, axis=spring.axis,
                             armature=inertia, **stiff_friction(torque))
            link = assembly.spec.add_tendon(
                name=f"branch_{joint}_{number}", stiffness=[branch, 0, 0],
                damping=[0.2 * np.sqrt(branch * inertia), 0, 0], springlength=[0, 0])
            link.wrap_joint(spring.name, 1)
            link.wrap_joint(f"slider_{joint}_{number}", -1)


class TransmissionRipple(Effect):
    """The spring's rest angle moves with the motor's: amplitude·sin(order·q + phase)."""

    name = "transmission_ripple"

    def prepare(self, simulation):
        self._spring = simulation.qpos(f"spring_{self.joint}")
        self._motor = simulation.motor[self.joint - 1]

    def step(self, simulation, row):
        wave = self.parameters
        angle = wave["order"] * simulation.data.qpos[self._motor] + wave["phase"]
        simulation.model.qpos_spring[self._spring] = wave["amplitude"] * np.sin(angle)


class ServoLag(Effect):
    """time_constant: s. Joint None: all six."""

    name = "servo_lag"

    def prepare_servo(self, servo):
        joints = slice(None) if self.joint is None else self.joint - 1
        servo.set_lag(joints, self.parameters["time_constant"])


class Resonance(Effect):
    """The process chatters with `force` (3,) (N, rms, base frame) about the natural `frequency` (Hz)
    of a joint's spring and what it carries, which is damped by `damping` of critical."""

    name = "resonance"
    BAND = 0.8, 1.2  # of the frequency, where the process chatters
    LINES = 12
    GROW = 2.0  # s

    def __init__(self, joint, frequency, damping, force):
        super().__init__(joint, frequency=frequency, damping=damping)
        self.force = force

    def begin(self, rng, course):
        frequency = self.parameters["frequency"] * rng.uniform(*self.BAND, self.LINES)
        phase = rng.uniform(0, 2 * np.pi, self.LINES)
        wave = np.sin(2 * np.pi * np.outer(course.time, frequency) + phase).sum(1)
        wave *= np.sqrt(2 / self.LINES) * np.clip(course.time / self.GROW, 0, 1)
        wrench = course.wrench.copy()
        wrench[:, :3] += np.outer(wave, self.force)
        return dataclasses.replace(course, wrench=wrench)

    def prepare(self, simulation):
        model, dof = simulation.model, simulation.dof(f"spring_{self.joint}")
        stiffness = model.joint(f"spring_{self.joint}").stiffness[0]
        omega = 2 * np.pi * self.parameters["frequency"]
        model.dof_damping[dof] = 2 * self.parameters["damping"] * stiffness / omega
