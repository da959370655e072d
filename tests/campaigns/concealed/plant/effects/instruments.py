"""Effects of the force sensor and the clocks."""

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from .base import Effect


def _read_in_tool_frame(signals, change):
    """Replaces the wrench by what `change` makes of force and moment (n, 3) in the tool frame."""
    halves = [np.einsum("nji,nj->ni", signals.tool, half)
              for half in (signals.wrench[:, :3], signals.wrench[:, 3:])]
    signals.wrench = np.concatenate(
        [np.einsum("nij,nj->ni", signals.tool, half) for half in change(*halves)], 1)


class WrenchBias(Effect):
    """fx, fy, fz: N, mx, my, mz: N·m that the sensor reads at none, tool frame."""

    name = "wrench_bias"

    def sense(self, signals, description):
        bias = np.array([self.parameters.get(name, 0.0)
                         for name in ("fx", "fy", "fz", "mx", "my", "mz")])
        _read_in_tool_frame(signals, lambda force, moment: (force + bias[:3], moment + bias[3:]))


class WrenchScale(Effect):
    """gain_error: the sensor reads 1 + gain_error times the wrench."""

    name = "wrench_scale"

    def sense(self, signals, description):
        self.parameters["gain"] = 1 + self.parameters["gain_error"]
        signals.wrench = signals.wrench * self.parameters["gain"]


class WrenchFrame(Effect):
    """rx, ry, rz: rotation vector (rad, tool frame) by which the reading is turned."""

    name = "wrench_frame"

    def sense(self, signals, description):
        vector = [self.parameters[name] for name in ("rx", "ry", "rz")]
        turn = Rotation.from_rotvec(vector).as_matrix()
        _read_in_tool_frame(signals, lambda force, moment: (force @ turn.T, moment @ turn.T))


class TimeOffset(Effect):
    """delay: s by which a group of columns (as in motion.Signals) comes late, uncompensated."""

    name = "time_offset"

    def __init__(self, group, delay):
        super().__init__(None, delay=delay)
        self.group = group

    def sense(self, signals, description):
        late = signals.time - self.parameters["delay"]
        course = CubicSpline(signals.time, getattr(signals, self.group))
        setattr(signals, self.group, course(np.clip(late, signals.time[0], signals.time[-1])))
