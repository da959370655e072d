"""A circle that a concealed plant mills: commanded, carried out, and how round it became."""

import dataclasses

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from campaign import kinds, paths
from campaign.case import ATTEMPTS, Unsuitable
from plant import recording, simulation
from plant.effects.base import Effect
from plant.servo import holding_torque

PERIOD = 4e-3  # s, of the robot's controller
SMOOTHED = 0.05  # s: a controller's interpolator rounds off steps of a correction
AXES = "xyz"


class ForceFedForward(Effect):
    """The controller is told the cutting force, as it is for the compensation: its position loop
    alone would give way by a few hundredths of a millimetre."""

    name = "force_fed_forward"

    def __init__(self, description, motion):
        super().__init__(None)
        self._torque = holding_torque(description, motion)

    def prepare_servo(self, servo):
        servo.feed_forward(self._torque)


def _recorded(motion):
    """Rows of a motion at the controller's period, after the run-in."""
    stride = round(PERIOD / motion.step)
    return np.arange(round(motion.run_in / motion.step), len(motion.time), stride)


@dataclasses.dataclass
class Circle:
    """plane: name of paths.PLANES. program: a Motion, uncorrected."""

    program: object
    plane: str
    rng_seed: list

    def run(self, description, effects, correction=None):
        """Signals of the plant. correction: (rows at the controller's period, 6) rad, added to the
        commands after the run-in, during which it grows."""
        motion = self.program
        if correction is not None:
            motion = self._corrected(correction)
        told = ForceFedForward(description, motion)
        return simulation.simulate(description, [*effects, told], motion,
                                   np.random.default_rng(self.rng_seed))

    def _corrected(self, correction):
        motion, rows = self.program, _recorded(self.program)
        smooth = gaussian_filter1d(correction, SMOOTHED / PERIOD, axis=0, mode="nearest")
        ends = [motion.time[0], motion.time[rows[0]] - motion.run_in / 2]
        # It begins at rest; at the end it goes on as it was for the part of a period that is left: to be
        # brought to rest there would take the accelerations of a blow.
        course = CubicSpline(np.concatenate([ends, motion.time[rows]]),
                             np.concatenate([np.zeros((2, 6)), smooth]),
                             bc_type=((1, np.zeros(6)), (2, np.zeros(6))))
        return dataclasses.replace(motion, q=motion.q + course(motion.time),
                                   velocity=motion.velocity + course(motion.time, 1),
                                   acceleration=motion.acceleration + course(motion.time, 2))

    def write_program(self, signals, path):
        """The controller's view: commands, and the wrench as its sensor reads it."""
        rows = _recorded(self.program)
        recording.write(path, signals.time[rows] - signals.time[rows[0]], {
            "q_cmd": self.program.q[rows], "wrench": signals.wrench[rows],
            "temp_c": signals.temp_c[rows, None]})

    def write_course(self, signals, path):
        """Where the TCP really went."""
        rows = _recorded(self.program)
        recording.write(path, signals.time[rows] - signals.time[rows[0]], {"xyz": signals.xyz[rows]})

    @property
    def columns(self):
        first, second = paths.PLANES[self.plane]
        return f"{AXES[first]},{AXES[second]}"


def draw(rng, description, center, rated, seed):
    """A Circle about a posture that is like `center` (6,). Raises Unsuitable."""
    for _ in range(ATTEMPTS):
        try:
            motion, plane = kinds.circle(rng, paths.Arm(description), paths.nearby(rng, center),
                                         rated * rng.uniform(0.25, 0.5), rng.uniform(30, 36))
        except paths.Unreachable:
            continue
        rows = len(motion.time)
        motion.temperature[:] = kinds.warming(rng, np.arange(rows) / rows)
        return Circle(motion, plane, [seed, 2])
    raise Unsuitable("no circle within reach")
