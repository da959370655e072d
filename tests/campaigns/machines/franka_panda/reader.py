"""Franka Emika Panda: an exciting motion with the torques of the sensors behind its gears.

Recording: github.com/marcocognetti/FrankaEmikaPandaDynModel, commit 24d85ce (GPL-3.0). Masses,
centres and inertias: identified by Gaz, Cognetti, Oliva, Robuffo Giordano and De Luca, IEEE RA-L
4(4), 2019, as they also stand in franka_description; the sets are equivalent for torques, not the
robot's true parts.

The model leaves out all friction and the zeros of the torque sensors.
"""

import math

import numpy as np

from ..chain import Body, Chain, Joint, by_modified_parameters, tensor
from ..geometry import moved
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import Damaged, read_table, stacked, write_recording

TITLE = "Franka Emika Panda"
LEFT_OUT = "all friction, zeros of the torque sensors"
FOLDER = "franka_panda_gaz"
RECORDING = "panda_exciting_1kHz.csv"
FILES = [RECORDING]

JOINTS = range(1, 8)
FORMS = ("q_rad_{}", "dq_rads_{}", "tau_Nm_{}")
COLUMNS = ["t_s"] + [form.format(joint) for form in FORMS for joint in JOINTS]
PERIOD = 0.001  # s, of the controller
LEAST_SPEED = 0.1  # rad/s, of all joints together, for angles to tell the time that passed
TRAINING_PART = 0.75

# Craig's parameters a (m), d (m), alpha.
LINKS = ((0.0, 0.333, 0.0), (0.0, 0.0, -math.pi / 2), (0.0, 0.316, math.pi / 2),
         (0.0825, 0.0, math.pi / 2), (-0.0825, 0.384, -math.pi / 2), (0.0, 0.0, math.pi / 2),
         (0.088, 0.0, math.pi / 2))
FLANGE = 0.107  # m beyond the last joint
RANGE = ((-2.8973, 2.8973), (-1.7628, 1.7628), (-2.8973, 2.8973), (-3.0718, -0.0698),
         (-2.8973, 2.8973), (-0.0175, 3.7525), (-2.8973, 2.8973))  # rad
BODIES = (  # in the joints' frames
    Body(4.970684, np.array([3.875e-3, 2.081e-3, -0.04762]),
         tensor(0.70337, 0.70661, 9.117e-3, -1.39e-4, 1.9169e-2, 6.772e-3)),
    Body(0.646926, np.array([-3.141e-3, -2.872e-2, 3.495e-3]),
         tensor(7.962e-3, 2.811e-2, 2.5995e-2, -3.925e-3, 7.04e-4, 1.0254e-2)),
    Body(3.228604, np.array([2.7518e-2, 3.9252e-2, -6.6502e-2]),
         tensor(3.7242e-2, 3.6155e-2, 1.083e-2, -4.761e-3, -1.2805e-2, -1.1396e-2)),
    Body(3.587895, np.array([-5.317e-2, 0.104419, 2.7454e-2]),
         tensor(2.5853e-2, 1.9552e-2, 2.8323e-2, 7.796e-3, 8.641e-3, -1.332e-3)),
    Body(1.225946, np.array([-1.1953e-2, 4.1065e-2, -3.8437e-2]),
         tensor(3.5549e-2, 2.9474e-2, 8.627e-3, -2.117e-3, 2.29e-4, -4.037e-3)),
    Body(1.666555, np.array([6.0149e-2, -1.4117e-2, -1.0517e-2]),
         tensor(1.964e-3, 4.354e-3, 5.433e-3, 1.09e-4, 3.41e-4, -1.158e-3)),
    Body(0.735522, np.array([1.0517e-2, -4.252e-3, 6.1597e-2]),
         tensor(1.2516e-2, 1.0027e-2, 4.815e-3, -4.28e-4, -7.41e-4, -1.196e-3)))


def chain():
    joints = [Joint(place, [body], lower, upper)
              for place, body, (lower, upper) in zip(by_modified_parameters(LINKS), BODIES, RANGE)]
    return Chain("Franka Emika Panda", joints, tool=moved(z=FLANGE))


def controller_time(host, angle, speed):
    """Times (n,) s in whole periods of the controller, from the host's and from how far the joints
    went.

    The host polled the controller: it missed some samples, and its own times wander by
    milliseconds. Between two samples of angle and speed, (n, 7), the time that passed is step·speed
    / speed².
    """
    mean_speed = (speed[1:] + speed[:-1]) / 2
    power = (mean_speed**2).sum(axis=1)
    moving = power > LEAST_SPEED**2
    passed = np.diff(host)
    steps = (np.diff(angle, axis=0) * mean_speed).sum(axis=1)
    passed[moving] = steps[moving] / power[moving]
    periods = np.maximum(np.rint(passed / PERIOD), 1)
    return np.append(0, np.cumsum(periods)) * PERIOD


def is_whole(angle, speed):
    """Which rows (n,) are a sample of the controller met for the first time, and all of it.

    A sample met twice repeats its speeds. In one row of a thousand the speeds are new and the
    angles still those of the row before, although the robot moves.
    """
    has_speeds = np.any(np.diff(speed, axis=0) != 0, axis=1)
    has_angles = np.any(np.diff(angle, axis=0) != 0, axis=1)
    stands = (speed[1:] ** 2).sum(axis=1) < LEAST_SPEED**2
    return np.append(True, has_speeds & (has_angles | stands))


def read(path):
    """Time (n,) s, angles (n, 7) rad, torques (n, 7) N·m; every sample of the controller once."""
    table = read_table(path, COLUMNS, rising="t_s")
    angle, speed, torque = (stacked(table, form, JOINTS) for form in FORMS)
    is_new = is_whole(angle, speed)
    if is_new.sum() < 2:
        raise Damaged(f"{path}: the robot does not move")
    time = controller_time(table["t_s"][is_new], angle[is_new], speed[is_new])
    return time, angle[is_new], torque[is_new]


def write(data, folder):
    """One experiment: the last quarter of the motion is held out."""
    time, angle, torque = read(data / RECORDING)
    model = write_robot(folder, chain())
    is_training = time <= TRAINING_PART * time[-1]
    training, held_out = (
        write_recording(folder / f"{name}.csv", time[rows], q_meas=angle[rows], tau=torque[rows])
        for name, rows in (("training", is_training), ("held_out", ~is_training)))
    return [Experiment("torques", model, [training], held_out)]
