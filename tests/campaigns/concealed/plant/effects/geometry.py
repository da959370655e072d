"""Where things are."""

import numpy as np

from .base import Effect


class JointOffset(Effect):
    """offset: rad; the joint stands at its encoder's reading plus this."""

    name = "joint_offset"

    def sense(self, signals, description):
        signals.q_meas[:, self.joint - 1] -= self.parameters["offset"]


class LinkLength(Effect):
    """length: m longer, towards the next joint."""

    name = "link_length"

    def alter(self, description):
        following = description.joints[self.joint]
        along = following.position / np.linalg.norm(following.position)
        following.position = following.position + self.parameters["length"] * along


class TcpOffset(Effect):
    """x, y, z: m, in the tool frame; what is mounted on the flange stays where it is."""

    name = "tcp_offset"

    def alter(self, description):
        shift = np.array([self.parameters[name] for name in "xyz"])
        last = description.chain[-1]
        last.position = last.position + last.rotation @ shift
        description.payload_center = description.payload_center - shift


class ThermalDrift(Effect):
    """The robot's foot creeps with the temperature, by x, y, z (m/K, base frame) since the
    recording began; with time_constant (s) in m, towards a limit with time."""

    name = "thermal_drift"

    def prepare(self, simulation):
        motion, parameters = simulation.motion, self.parameters
        first = np.searchsorted(motion.time, motion.time[0] + motion.run_in)
        if "time_constant" in parameters:
            growth = -np.expm1(-(motion.time - motion.time[first]) / parameters["time_constant"])
        else:
            growth = motion.temperature - motion.temperature[first]
        self._course = np.outer(growth, [parameters[name] for name in "xyz"])
        self._course[:first] = 0

    def step(self, simulation, row):
        if row is not None:
            simulation.model.body("base").pos[:] = self._course[row]
