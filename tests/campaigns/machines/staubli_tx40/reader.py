"""Stäubli TX40: an exciting motion of all six joints with the torques of the motors.

Recording and model: github.com/thanhndv212/figaroh-examples, commit c0b5c7f (2025-09-05), examples/
staubli_TX40 (terms as FIGAROH, Apache-2.0): motor angles and torques at 5 kHz for 9 s, geometry,
masses and inertias.

Joint angle = motor angle over its gear ratio; the wrist is coupled: motor 6 also turns when joint 5
does, so that the angle of joint 5 is taken from that of motor 6, and the torque of motor 6 acts on
joint 5 too. The model leaves out that this motor's friction and rotor follow its own speed, and all
friction and rotors. A recording comes once low-passed at 40 Hz, angles and torques by the same
filter, and once as every tenth row of what was recorded.
"""

import gzip
import math

import numpy as np

from ..chain import JOINTS
from ..published_urdf import read_chain
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import Damaged, write_recording

TITLE = "Stäubli TX40"
LEFT_OUT = "all friction, rotors, the coupling of the wrist's motors"
FOLDER = "staubli_tx40"
ANGLES, TORQUES, MODEL = "pos_read_data.csv.gz", "curr_data.csv.gz", "tx40_mdh_modified.urdf"
FILES = [ANGLES, TORQUES, MODEL]

RATE = 5000.0  # Hz
RATIO = np.array([32.0, 32.0, 45.0, -48.0, 45.0, 32.0])
ZERO = np.array([0.0, -math.pi / 2, math.pi / 2, 0.0, 0.0, 0.0])  # rad, of the joints
EVERY = 10  # rows
CUTOFF = 40.0  # Hz
HALF_WINDOW = 500  # rows
TRAINING_PART = 0.6


def read_rows(path):
    """(n, 6), a header first."""
    try:
        with gzip.open(path, "rt") as file:
            values = np.loadtxt(file, delimiter=",", skiprows=1, ndmin=2)
    except (OSError, EOFError, ValueError, UnicodeDecodeError) as error:
        raise Damaged(f"{path}: {error}") from error
    if values.shape[1:] != (JOINTS,) or len(values) < 10 * HALF_WINDOW:
        raise Damaged(f"{path}: expected {JOINTS} columns and {10 * HALF_WINDOW} rows or more, "
                      f"found {values.shape[1]} and {len(values)}")
    return values


def of_joints(motor_angles, motor_torques):
    """Angles (rad) and torques (N·m) of the joints, (n, 6) each."""
    angles, torques = motor_angles / RATIO, motor_torques * RATIO
    angles[:, 5] -= angles[:, 4]
    torques[:, 4] += torques[:, 5]
    return angles + ZERO, torques


def low_passed(values):
    """By a windowed sine cardinal, without delay; shorter by half a window at either end."""
    lag = np.arange(-HALF_WINDOW, HALF_WINDOW + 1)
    window = np.cos(0.5 * math.pi * lag / (HALF_WINDOW + 1)) ** 2
    weight = np.sinc(2 * CUTOFF / RATE * lag) * window
    weight /= weight.sum()
    return np.column_stack([np.convolve(column, weight, "valid") for column in values.T])


def write(data, folder):
    """Two experiments, low-passed and as recorded; the last two fifths are held out."""
    model = write_robot(folder, read_chain(data / MODEL, "Staubli TX40", "base_link", f"link_{JOINTS}"))
    motor_angles, motor_torques = read_rows(data / ANGLES), read_rows(data / TORQUES)
    if len(motor_angles) != len(motor_torques):
        raise Damaged(f"{data / TORQUES}: {len(motor_torques)} rows, but {len(motor_angles)} angles")
    angles, torques = of_joints(motor_angles, motor_torques)
    time = np.arange(len(angles)) / RATE
    inner = slice(HALF_WINDOW, -HALF_WINDOW)
    experiments = []
    for name, rows in (("filtered", (time[inner], low_passed(angles), low_passed(torques))),
                       ("recorded", (time, angles, torques))):
        t, q, tau = (values[::EVERY] for values in rows)
        is_training = t <= TRAINING_PART * time[-1]
        training, held_out = (
            write_recording(folder / f"{name}_{part}.csv", t[chosen], q_meas=q[chosen],
                            tau=tau[chosen])
            for part, chosen in (("training", is_training), ("held_out", ~is_training)))
        experiments.append(Experiment(name, model, [training], held_out))
    return experiments
