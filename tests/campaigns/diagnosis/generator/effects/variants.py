"""The catalogue's effects in other forms than its laws have. The name that a diagnosis should give is the
effect's; a law of its own at the right joint says as much.

Real machines brought them up: drifts along the tool or of a joint's zero, gains of some channels only, play
and loops whose side the torque decides.
"""

import numpy as np
from scipy import signal

from .. import memory
from ..kinematics import turn
from .base import direction, log_uniform, one, signed
from .geometry import JointOffset, ThermalDrift
from .instruments import WrenchScale
from .torques import CoulombFriction, StribeckFriction
from .transmission import Backlash, Hysteresis, Resonance, ServoLag, TransmissionRipple

ARM = (1, 2, 3, 4, 5, 6)


def _rise(state):
    return state.temperature - state.temperature[0]


class DriftAlongTool(ThermalDrift):
    """The spindle grows: a fixed direction of the tool's frame."""

    form = "along the tool"

    def draw(self, rng, joint, robot, scale):
        return {"growth": log_uniform(rng, 8e-6, 4e-5)}

    def apply(self, machine, joint, parameters):
        axis = parameters["growth"] * np.array([1.0, 0, 0])  # out of the flange
        machine.shift.append(
            lambda state, rotation: _rise(state)[:, None] * turn(rotation, axis))


class DriftOfZero(ThermalDrift):
    """A joint's zero creeps as its gear warms."""

    form = "of a joint's zero"
    groups = ("xyz", "q_link")
    joints = ARM

    def draw(self, rng, joint, robot, scale):
        return {"zero_rate": signed(rng, 5e-6, 4e-5)}

    def apply(self, machine, joint, parameters):
        _, column = one(machine, joint)
        machine.transmission.append(
            lambda state: parameters["zero_rate"] * _rise(state)[:, None] * column)


class DriftBehind(ThermalDrift):
    """The structure follows the sensor's temperature with a lag."""

    form = "behind the temperature"

    def draw(self, rng, joint, robot, scale):
        return super().draw(rng, joint, robot, scale) | {"behind": float(rng.uniform(5, 15))}

    def apply(self, machine, joint, parameters):
        growth = np.array([parameters[name] for name in "xyz"])

        def moved(state, rotation):
            rise = _rise(state)
            step = max(float(np.median(np.diff(state.time))), 1e-3)
            keep = np.exp(-step / parameters["behind"])
            late = signal.lfilter([1 - keep], [1, -keep], rise)
            return np.outer(late, growth)

        machine.shift.append(moved)


class ForceGain(WrenchScale):
    """The forces read wrong, the moments right."""

    form = "forces alone"

    def apply(self, machine, joint, parameters):
        factor = np.array([parameters["gain"]] * 3 + [1.0] * 3)
        machine.sensor.append(lambda local: local * factor)


class ChannelGain(WrenchScale):
    """One force reads wrong."""

    form = "one channel"

    def draw(self, rng, joint, robot, scale):
        return super().draw(rng, joint, robot, scale) | {"channel": int(rng.integers(3))}

    def apply(self, machine, joint, parameters):
        factor = np.ones(6)
        factor[parameters["channel"]] = parameters["gain"]
        machine.sensor.append(lambda local: local * factor)


class RippleOfLittleMotion(TransmissionRipple):
    """In a joint that moves by some degrees: only a fine tooth shows."""

    form = "in a joint that hardly moves"

    def draw(self, rng, joint, robot, scale):
        drawn = super().draw(rng, joint, robot, scale)
        periods = rng.uniform(2, 5)
        drawn["order"] = float(np.round(2 * np.pi * periods / max(scale.span[joint - 1], 1e-3)))
        return drawn


class ZeroInTorques(JointOffset):
    """The zero shows by weight alone."""

    form = "in torques"
    groups = ("tau",)
    kinds = ("torque",)
    hints = {"gravity": True}
    joints = (2, 3, 4, 5)

    def draw(self, rng, joint, robot, scale):
        return {"offset": signed(rng, 3e-3, 5e-2)}


class PlayByTorque(Backlash):
    """The link rests on the flank that the torque's sign says; nothing holds it."""

    form = "side by torque"
    kinds = ("circle", "link", "static", "mixed")

    def draw(self, rng, joint, robot, scale):
        return {"gap": log_uniform(rng, 1e-4, 8e-4)}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)
        machine.memory.append(
            lambda state, load: 0.5 * parameters["gap"] * np.sign(load[:, k])[:, None] * column)


class HysteresisBeyond(Hysteresis):
    """The loop opens beyond a load; below it the joint is only a spring."""

    form = "with a threshold"

    def draw(self, rng, joint, robot, scale):
        share = float(rng.uniform(0.1, 0.3))
        return super().draw(rng, joint, robot, scale) | {
            "threshold": share * float(scale.load[joint - 1])}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)
        loop = memory.prandtl_ishlinskii if parameters["sliding"] else memory.bouc_wen
        limit = parameters["threshold"]

        def series(state, load):
            beyond = load[:, k] - np.clip(load[:, k], -limit, limit)
            return -parameters["amplitude"] * loop(beyond, parameters["yield_torque"])[:, None] * column

        machine.memory.append(series)


class VibrationInTorques(Resonance):
    """The drive's own mode: the motor's inertia swings against the gear, and only its torque shows it."""

    form = "in torques"
    groups = ("tau",)
    kinds = ("torque",)

    def draw(self, rng, joint, robot, scale):
        share = log_uniform(rng, 0.05, 0.3)
        inertia = share * scale.torque[joint - 1] / max(scale.acceleration[joint - 1], 1e-3)
        return super().draw(rng, joint, robot, scale) | {"swinging": float(inertia)}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)

        def ringing(state):
            step = state.time[1] - state.time[0]
            pushed = parameters["swinging"] * state.acceleration[:, k]
            ring = memory.mode(pushed, step, parameters["frequency"], parameters["damping"])
            return (ring - pushed)[:, None] * column

        machine.torque.append(ringing)


class FrictionOneWay(CoulombFriction):
    """More friction one way than the other."""

    form = "one way"

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)
        machine.torque.append(lambda state: parameters["torque"] * (
            state.velocity[:, k] > 0).astype(float)[:, None] * column)


class StribeckStraight(StribeckFriction):
    """Friction that falls as exp(-|v|/v_s) (Tustin's), not by the square."""

    form = "Tustin's"

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)

        def friction(state):
            speed = state.velocity[:, k]
            fall = np.exp(-np.abs(speed) / parameters["speed"])
            return parameters["excess"] * (fall * np.sign(speed))[:, None] * column

        machine.torque.append(friction)


class LagOfSecondOrder(ServoLag):
    """A position loop that overshoots nothing, of second order: two lags in a row."""

    form = "second order"
    joints = ARM
    groups = ("xyz",)
    kinds = ("circle", "air")

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)
        half = parameters["time_constant"] / 2
        machine.lag[k] += half

        def behind(state):
            return -half * state.velocity[:, k][:, None] * column

        machine.transmission.append(behind)


class LateClock(JointOffset):
    """Positions come late by more and more: two clocks of different rates."""

    name = "time_offset"
    form = "a clock that runs slow"
    groups = ("xyz",)
    kinds = ("circle", "air")
    joints = (None,)
    units = {"delay": "s"}

    def draw(self, rng, joint, robot, scale):
        return {"rate": signed(rng, 2e-4, 2e-3)}

    def apply(self, machine, joint, parameters):
        def late(state):
            return -parameters["rate"] * (state.time - state.time[0])[:, None] * state.velocity

        machine.transmission.append(late)


VARIANTS = (DriftAlongTool(), DriftOfZero(), DriftBehind(), ForceGain(), ChannelGain(),
            RippleOfLittleMotion(), ZeroInTorques(), PlayByTorque(), HysteresisBeyond(),
            VibrationInTorques(), FrictionOneWay(), StribeckStraight(), LagOfSecondOrder(), LateClock())
