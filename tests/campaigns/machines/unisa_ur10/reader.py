"""Universal Robots UR10 (CB3): an exciting motion of all six joints with the torques of its motors.

Recording: V. Petrone, E. Ferrentino, P. Chiacchio, "The dynamic model of the UR10 robot and its ROS2
integration", IEEE Transactions on Industrial Informatics 2025; github.com/unisa-acg/inverse-dynamics-solver,
commit 41e196d (BSD-3-Clause), a ROS 2 bag. Its owners made torques of motor currents by gains that they
identified. Geometry, masses and centres are the manufacturer's ("DH parameters for calculations of
kinematics and dynamics"), inertias those of the ROS description of the arm: cylinders.

The model leaves out all friction, the rotors, and what the masses are off by.
"""

import math

import numpy as np

from .. import joint_states
from ..chain import Body, Chain, Joint, by_standard_parameters, tensor

TITLE = "Universal Robots UR10, torques of its motors"
LEFT_OUT = "all friction, rotors, true inertias"
FOLDER = "unisa_ur10"
RECORDING = "ur10_exciting_trajectory.csv"
FILES = [RECORDING]
TRAINING_PART = 0.7

# a (m), d (m), alpha; masses (kg) with their centres (m) in the frames at the links' far ends.
LINKS = ((0.0, 0.1273, math.pi / 2), (-0.612, 0.0, 0.0), (-0.5723, 0.0, 0.0),
         (0.0, 0.163941, math.pi / 2), (0.0, 0.1157, -math.pi / 2), (0.0, 0.0922, 0.0))
BODIES = (
    Body(7.1, np.array([0.021, 0.0, 0.027]), tensor(0.0315, 0.0219, 0.0315, 0, 0, 0)),
    Body(12.7, np.array([0.38, 0.0, 0.158]), tensor(0.0364, 0.4218, 0.4218, 0, 0, 0)),
    Body(4.27, np.array([0.24, 0.0, 0.068]), tensor(0.0109, 0.1108, 0.1108, 0, 0, 0)),
    Body(2.0, np.array([0.0, 0.007, 0.018]), tensor(0.0051, 0.0055, 0.0051, 0, 0, 0)),
    Body(2.0, np.array([0.0, 0.007, 0.018]), tensor(0.0051, 0.0055, 0.0051, 0, 0, 0)),
    Body(0.365, np.array([0.0, 0.0, -0.026]), tensor(0.0001, 0.0001, 0.0002, 0, 0, 0)))


def chain():
    places, ends = by_standard_parameters(LINKS)
    joints = [Joint(place, [body.seen_from(end)]) for place, end, body in zip(places, ends, BODIES)]
    return Chain("Universal Robots UR10", joints, tool=ends[-1])


def write(data, folder):
    """One experiment: the last three tenths of the motion are held out."""
    return joint_states.write(data / RECORDING, folder, chain(), TRAINING_PART)
