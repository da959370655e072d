"""Sensors that read wrong in ways of their own."""

import numpy as np

from .law import Foreign, lagged, law


class HotDrive(Foreign):
    """A motor gives less by its heat, which its current shows too high: it reads
    τ (1 + loss·h), where h follows (τ/rated)² with a lag of `time` s. When the recording begins, it has
    long been holding."""

    name = "hot_drive"
    kin = ("torque_gain/heat",)

    def begin(self, rng, course):
        self._begin = course.time[0] + course.run_in
        return course

    def heat(self, time, torque):
        """(n,)"""
        found = (torque / self.parameters["rated"]) ** 2
        first = np.searchsorted(time, self._begin)
        found[first:] = lagged(time[first:], found[first:], self.parameters["time"])
        return found

    def sense(self, signals, description):
        column = signals.tau[:, self.joint - 1]
        column *= 1 + self.parameters["loss"] * self.heat(signals.time, column)

    def places(self):
        return [("sensor tau", self.joint), ("joint_torque", self.joint)]

    def laws(self):
        own, tau = self.parameters, f"tau{self.joint}"
        return [law("sensor tau", f"g*{tau}*lag(({tau}/r)^2,T)", joint=self.joint, g=own["loss"],
                    r=own["rated"], T=own["time"])]


def _in_tool_frame(signals, change):
    """Replaces the wrench by what `change` makes of it (n, 6) in the tool frame."""
    halves = [np.einsum("nji,nj->ni", signals.tool, half)
              for half in (signals.wrench[:, :3], signals.wrench[:, 3:])]
    shown = change(np.concatenate(halves, 1))
    signals.wrench = np.concatenate([np.einsum("nij,nj->ni", signals.tool, half)
                                     for half in (shown[:, :3], shown[:, 3:])], 1)


class ForceSaturation(Foreign):
    """A force sensor's gain falls with the force: of a force f along axis `axis` of the tool it
    reads limit·tanh(f/limit), N."""

    name = "force_saturation"

    def sense(self, signals, description):
        axis, limit = int(self.parameters["axis"]), self.parameters["limit"]

        def change(wrench):
            wrench[:, axis] = limit * np.tanh(wrench[:, axis] / limit)
            return wrench

        _in_tool_frame(signals, change)

    def places(self):
        return [("sensor f" + "xyz"[int(self.parameters["axis"])], None)]


class ForceCrosstalk(Foreign):
    """A moment about axis `moment` shows as a force along axis `force` of the tool; share: 1/m."""

    name = "force_crosstalk"

    def sense(self, signals, description):
        own = self.parameters

        def change(wrench):
            wrench[:, int(own["force"])] += own["share"] * wrench[:, 3 + int(own["moment"])]
            return wrench

        _in_tool_frame(signals, change)

    def places(self):
        return [("sensor f" + "xyz"[int(self.parameters["force"])], None)]
