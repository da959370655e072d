"""Between motor and link: play, loops, ripple, and what follows late or vibrates."""

import numpy as np

from .. import memory
from .base import ALL_JOINTS, Effect, log_uniform, one


class Backlash(Effect):
    """Play between motor and link. Under load the torque decides on which flank the link rests; with
    next to no load the motor drags the link behind it."""

    name = "backlash"
    joints = ALL_JOINTS
    groups = ("xyz", "q_link")
    kinds = ("circle", "air", "link", "static", "mixed")
    units = {"gap": "rad"}

    def draw(self, rng, joint, robot, scale):
        loaded = scale.load[joint - 1] > 1.0
        return {"gap": log_uniform(rng, 1e-4, 8e-4),
                "hold": float(rng.uniform(0.01, 0.04) * scale.load[joint - 1]) if loaded else 0.0}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)
        half = 0.5 * parameters["gap"]

        def play(state, load):
            if parameters["hold"]:
                series = half * memory.flank(load[:, k], parameters["hold"])
            else:
                series = memory.motion_play(state.q[:, k], half) - state.q[:, k]
            return series[:, None] * column

        machine.memory.append(play)

    def probes(self, joint, robot, scale):
        holds = [share * scale.load[joint - 1] for share in (0.01, 0.04)]
        return [[{"gap": 3e-4, "hold": hold}] for hold in holds] + [[{"gap": 3e-4, "hold": 0.0}]]


class Hysteresis(Effect):
    """A rate-independent loop of torque and deflection beside the spring, which lags behind its load
    and so takes energy: Bouc and Wen's, or Prandtl and Ishlinskii's sum of sliding elements."""

    name = "hysteresis"
    joints = ALL_JOINTS
    groups = ("xyz", "q_link")
    kinds = ("circle", "link", "static", "mixed")
    units = {"amplitude": "rad", "yield_torque": "N·m"}

    def draw(self, rng, joint, robot, scale):
        amplitude, sliding = log_uniform(rng, 5e-5, 4e-4), rng.random() < 0.5
        share = rng.uniform(0.15, 0.5)  # of the load, at which half of the sliding elements slide
        return {"amplitude": amplitude, "sliding": float(sliding),
                "yield_torque": float((0.5 if sliding else 1) * share * scale.load[joint - 1])}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)
        loop = memory.prandtl_ishlinskii if parameters["sliding"] else memory.bouc_wen

        def series(state, load):
            return (-parameters["amplitude"] * loop(load[:, k], parameters["yield_torque"])[:, None]
                    * column)

        machine.memory.append(series)

    def probes(self, joint, robot, scale):
        load = scale.load[joint - 1]
        return [[{"amplitude": 1e-4, "sliding": 0.0, "yield_torque": share * load}]
                for share in (0.05, 0.2, 0.5)]


class TransmissionRipple(Effect):
    """Position error of the gear, a sinusoid of the joint angle of `order` periods a turn."""

    name = "transmission_ripple"
    joints = ALL_JOINTS
    groups = ("xyz", "q_link")
    kinds = ("circle", "air", "link", "mixed")
    units = {"amplitude": "rad", "order": "1", "phase": "rad"}

    def draw(self, rng, joint, robot, scale):
        low = 4 * np.pi / max(scale.span[joint - 1], 1e-3)  # at least two periods seen
        low = float(np.clip(low, 30, 250))
        return {"amplitude": log_uniform(rng, 3e-5, 3e-4), "phase": float(rng.uniform(0, 2 * np.pi)),
                "order": float(np.round(rng.uniform(low, max(1.2 * low, 200))))}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)

        def error(state):
            wave = np.sin(parameters["order"] * state.q[:, k] + parameters["phase"])
            return parameters["amplitude"] * wave[:, None] * column

        machine.transmission.append(error)

    def probes(self, joint, robot, scale):
        low = 4 * np.pi / max(scale.span[joint - 1], 1e-3)
        return [[{"amplitude": 1e-4, "order": order, "phase": phase} for phase in (0, np.pi / 2)]
                for order in (low, 1.5 * low, 2 * low, 3 * low)]


class ServoLag(Effect):
    """The joint, or every joint (joint null), follows its command as a first-order lag."""

    name = "servo_lag"
    joints = (None,) + ALL_JOINTS
    groups = ("xyz", "tau")
    kinds = ("circle", "air", "torque")
    hints = {"encoders": "q_cmd"}
    units = {"time_constant": "s"}

    def draw(self, rng, joint, robot, scale):
        return {"time_constant": log_uniform(rng, 5e-3, 60e-3)}

    def apply(self, machine, joint, parameters):
        machine.lag[slice(None) if joint is None else joint - 1] += parameters["time_constant"]

    def probes(self, joint, robot, scale):
        return [[{"time_constant": 20e-3}]]


class Resonance(Effect):
    """The joint's spring and what it carries make a lightly damped mode: wind-up follows the load as
    a second-order system does, and the motor feels the vibrating torque."""

    name = "resonance"
    joints = ALL_JOINTS
    groups = ("xyz", "q_link", "tau")
    kinds = ("circle", "torque", "link")
    hints = {"rate": 200, "program": "moves"}
    units = {"frequency": "Hz", "damping": "1"}

    def draw(self, rng, joint, robot, scale):
        return {"frequency": float(rng.uniform(5.0, 20.0)), "damping": log_uniform(rng, 0.008, 0.05)}

    def apply(self, machine, joint, parameters):
        k, column = one(machine, joint)

        def vibration(state, load):
            step = state.time[1] - state.time[0]
            ring = memory.mode(load[:, k], step, parameters["frequency"], parameters["damping"])
            return (ring - load[:, k])[:, None] * column

        machine.memory.append(lambda state, load: machine.robot.compliance * vibration(state, load))
        machine.torque.append(lambda state: -vibration(state, state.dynamic_load))

    def probes(self, joint, robot, scale):
        return [[{"frequency": frequency, "damping": 0.02}] for frequency in (6.0, 9.0, 13.0, 18.0)]


EFFECTS = (Backlash(), Hysteresis(), TransmissionRipple(), ServoLag(), Resonance())
