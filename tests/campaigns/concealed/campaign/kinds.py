"""The kinds of recording, and what the robot does in each.

circle  milled circle: force and TCP measured
air     the same without cutting: TCP measured
torque  swings of all joints: torques measured
link    the same with link-side encoders
static  load test: a row a settled load
mixed   slow swings while grinding, every channel
"""

import numpy as np

from plant import assembly
from plant.motion import LoadTest, Motion

from . import cutting, paths

KINDS = ("circle", "air", "torque", "link", "static", "mixed")
GROUPS = {"circle": ("q_meas", "wrench", "xyz"), "air": ("q_meas", "xyz"),
          "torque": ("q_meas", "tau"), "link": ("q_meas", "q_link", "tau"),
          "static": ("q_meas", "wrench", "xyz"),
          "mixed": ("q_meas", "q_link", "tau", "wrench", "xyz")}
# Slow feeds and few harmonics keep what inertia bends below the tracker's noise: the simulation
# that recordings are compared with is quasi-static.
RAMP, RUN_IN = 3.0, 4.5  # s: motion and force grow; what no recording shows
SECONDS = {"circle": (30, 36), "air": (30, 36), "torque": (22, 30), "link": (22, 30),
           "mixed": (30, 36)}
POSES, STEPS = 10, 2  # of a load test; loads from nothing to the top
ROOM = 24.0  # °C


def _time(duration):
    return np.arange(round((duration + RUN_IN) / assembly.STEP)) * assembly.STEP


def warming(rng, share):
    """Temperatures over the work, share (n,) from 0 to 1 of its time."""
    rise, constant = rng.uniform(4, 10), rng.uniform(0.3, 0.8)
    return ROOM - rise * np.expm1(-share / constant)


def circle(rng, arm, center, cutting_force, duration):
    """A milled circle, in air if the force (N) is zero: (Motion, name of its plane). Raises
    paths.Unreachable."""
    time = _time(duration)
    plane, sense = str(rng.choice(list(paths.PLANES))), int(rng.choice([-1, 1]))
    radius = rng.uniform(0.05, 0.08)
    feed = 2 * np.pi * radius / duration * rng.uniform(1.0, 1.1)  # once round, and a little more
    q, velocity, acceleration, angle = paths.circle(
        arm, center, time, RAMP, radius, plane, feed, sense, rng.uniform(0, 2 * np.pi))
    wrench = np.zeros((len(time), 6))
    if cutting_force:
        wrench = cutting.milling(rng, time, RAMP, angle, plane, sense, cutting_force)
    return Motion(time, q, velocity, acceleration, wrench, np.zeros(len(time)), RUN_IN), plane


def _swing(rng, arm, description, center, duration, base, harmonics, fastest, force=0.0):
    time = _time(duration)
    share = rng.uniform(0.4, 1.0, 6) * fastest
    widest = np.array([0.9, 0.35, 0.4, 0.8, 0.6, 1.2])
    q, velocity, acceleration = paths.swing(rng, arm, description, center, time, RAMP, base,
                                            harmonics, share, widest)
    wrench = cutting.pushing(rng, time, RAMP, force) if force else np.zeros((len(time), 6))
    return Motion(time, q, velocity, acceleration, wrench, np.zeros(len(time)), RUN_IN)


def _load_test(rng, arm, center, force):
    postures = center + rng.uniform(-1, 1, (POSES, 6)) * np.array([0.5, 0.25, 0.3, 0.6, 0.4, 1.0])
    arm.check(postures)
    loads = cutting.load_loops(rng, POSES, STEPS, force)
    return LoadTest(postures, loads, np.zeros(loads.shape[0] * loads.shape[1]))


def course(rng, kind, description, center, rated, slow=False):
    """A Motion or LoadTest about a posture. rated: N; slow: swings much below the robot's speed.
    Raises paths.Unreachable."""
    arm = paths.Arm(description)
    if kind == "static":
        return _load_test(rng, arm, center, rated * rng.uniform(0.5, 0.9))
    duration = rng.uniform(*SECONDS[kind])
    if kind in ("circle", "air"):
        force = rated * rng.uniform(0.25, 0.5) if kind == "circle" else 0.0
        return circle(rng, arm, center, force, duration)[0]
    if kind == "mixed":
        return _swing(rng, arm, description, center, duration, 0.018, 2, 0.007,
                      0.3 * rated)
    return _swing(rng, arm, description, center, duration, 0.055, 3,
                  0.15 if slow else 0.5)
