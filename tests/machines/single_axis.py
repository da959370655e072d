"""Machines of one axis as robots of six joints.

1 rad of joint 1 stands for 1 m of travel and 1 N·m for 1 N. The moving mass sits on a lever of 1 m
about the upright joint 1, so that its inertia (kg·m²) is the mass (kg) by the same number; so are
N·s/m and N·m·s/rad, N and N·m. For torques this is exact: with one joint moving and no gravity, the
equation of motion is J q'' = torque. Joints 2 to 6 stand still and bear nothing, and where the TCP
lies means nothing.
"""

import math

import numpy as np

from .chain import JOINTS, Body, Chain, Joint
from .geometry import Frame, moved, turned
from .tables import write_recording

REACH = 0.2  # m, between the joints that stand: any that keeps them apart


def chain(name, mass):
    """A carriage of a mass in kg; none with zero."""
    bodies = [Body(mass, np.array([1.0, 0.0, 0.0]))] if mass > 0 else []
    standing = [Joint(moved(REACH) @ turned("x", math.pi / 2 if number % 2 else 0.0))
                for number in range(JOINTS - 1)]
    return Chain(name, [Joint(Frame(), bodies), *standing], moved(REACH), gravity=0.0)


def write(path, time, travel, force):
    """A recording of such a robot: time (n,) s, travel (n,) m, force of the drive (n,) N."""
    angles = np.zeros((len(time), JOINTS))
    angles[:, 0] = travel
    torques = np.full((len(time), JOINTS), np.nan)
    torques[:, 0] = force
    return write_recording(path, time, q_meas=angles, tau=torques)
