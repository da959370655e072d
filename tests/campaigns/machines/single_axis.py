"""Machines of one axis: a slide without weight, and recordings of its drive."""

import math

import numpy as np

from .chain import Body, Chain, Joint
from .geometry import Frame, turned
from .tables import write_recording

TRAVEL = 1.0  # m either way, more than any of them goes


def chain(name, mass):
    """A carriage of a mass in kg; none with zero."""
    bodies = [Body(mass, np.zeros(3))] if mass > 0 else []
    slide = Joint(turned("y", math.pi / 2), bodies, -TRAVEL, TRAVEL, slides=True)
    return Chain(name, [slide], Frame(), gravity=0.0)


def write(path, time, travel, force):
    """A recording of such a machine: time (n,) s, travel (n,) m, force of the drive (n,) N."""
    return write_recording(path, time, q_meas=travel[:, None], tau=force[:, None])
