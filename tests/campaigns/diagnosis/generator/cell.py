"""Robot, recordings to be and sensors, before anything is concealed in them."""

import dataclasses

import numpy as np

from . import kinds, machine as physics, robot as robots, sensors, setup
from .dynamics import about_axes, inverse_dynamics
from .effects.base import Scale
from .elasticity import loads as link_loads
from .kinematics import posture
from .trace import channels_of, difference, spread_rows

TINY = 0.1  # N·m, rad/s, rad/s²: below this a joint counts as unloaded or at rest


@dataclasses.dataclass
class Cell:
    """Base of a case: nominal robot, recordings to be, noise."""

    kind: str
    robot: object
    takes: list
    quality: sensors.Quality
    levels: dict  # group -> standard deviation of noise, a column each
    scale: Scale

    @property
    def training(self):
        return [take for take in self.takes if not take.holdout]

    def difference(self, machine, takes=None):
        """Trace that a machine's concealed physics leaves, in units of noise."""
        return difference(self.robot, machine, takes or self.training, self.levels, self.quality)


def _scale(robot, takes):
    """The largest of everything over the rows of the takes that are looked at."""
    largest, span = {}, []
    for take in takes:
        rows = spread_rows(take)
        model = physics.nominal(robot)
        state = physics.at(physics.motors(model, take.drive), rows)
        place = posture(robot, state.q)
        load = np.abs(about_axes(place, *link_loads(robot, place, state.wrench)))
        if "q_link" in take.columns:
            inertia = inverse_dynamics(robot, state.q, state.velocity, state.acceleration)
            load = np.maximum(load, np.abs(inertia))
        found = {"load": load, "torque": physics.predict(model, state, ["tau"])["tau"],
                 "speed": state.velocity, "acceleration": state.acceleration}
        for name, values in found.items():
            largest[name] = np.maximum(np.abs(values).max(0), largest.get(name, TINY))
        span.append(np.ptp(state.q, 0))
    largest["torque"] = np.maximum(largest["torque"], 0.01 * largest["torque"].max())
    return Scale(force=max(float(np.abs(take.drive.wrench[:, :3]).max()) for take in takes),
                 span=np.max(span, 0), **largest)


def draw(rng, kind, hints, folder):
    """A Cell whose robot's files are in folder. Raises Unreachable as `kinds.draw` does."""
    quality = sensors.draw_quality(rng)
    has_torque = kind in ("torque", "link", "mixed")
    if has_torque:
        hints = {"gravity_share": 0.85} | hints
    path, rated = setup.write_robot(rng, folder, hints, has_torque)
    robot = robots.load(path)
    takes = kinds.draw(kind, rng, robot, quality, hints, rated)
    training = [take for take in takes if not take.holdout]
    model = physics.nominal(robot)
    signals = physics.measure(model, training[0].drive, channels_of(training[0]),
                              spread_rows(training[0]))
    return Cell(kind, robot, takes, quality, sensors.noise_levels(quality, signals),
                _scale(robot, training))
