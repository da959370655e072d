"""What no recorded signal tells of: it has a course in time of its own."""

import numpy as np

from .law import Foreign


class FloorHum(Foreign):
    """A machine beside shakes the floor at one `frequency` (Hz) by `amplitude` (m) along an axis
    (0 to 2) of the base, with another phase in every recording."""

    name = "floor_hum"
    exists = False

    def begin(self, rng, course):
        self._phase = rng.uniform(0, 2 * np.pi)
        return course

    def moved(self, seen, place):
        own, shift = self.parameters, np.zeros_like(place)
        wave = np.sin(2 * np.pi * own["frequency"] * seen.time + self._phase)
        shift[:, int(own["axis"])] = own["amplitude"] * wave
        return place + shift

    def places(self):
        axis = "xyz"[int(self.parameters["axis"])]
        return [("base", axis), ("tcp_base", axis), (f"sensor {axis}", None)]


class SlippedPart(Foreign):
    """A clamp of a joint slips once in every recording, by `angle` (rad) at a moment of its own."""

    name = "slipped_part"
    exists = False
    kin = ("joint_offset",)
    begins = True

    def begin(self, rng, course):
        self._moment = rng.uniform(0.35, 0.7)
        return course

    def angle(self, seen):
        share = (seen.time - seen.time[0]) / (seen.time[-1] - seen.time[0])
        return self.parameters["angle"] * (share > self._moment)

    def places(self):
        return [("joint_angle", self.joint), ("joint_windup", self.joint)]
