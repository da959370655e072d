"""PAL TIAGo: an arm of seven joints on a torso that lifts, with the currents of its motors.

Recording and model: github.com/thanhndv212/figaroh-examples, commit c0b5c7f (2025-09-05), examples/tiago (terms as
FIGAROH, Apache-2.0): angles and currents at 100 Hz. Ratios, motor constants, the rows that count and the model
are those with which its owners identify the robot: it has the gripper.

Only the motors of the arm's first four joints report a current. The torso's torque and those of the wrist are
missing, and say so by empty cells. The model leaves out all friction and the rotors.
"""

import numpy as np

from ..published_urdf import read_chain
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import Damaged, read_table, stacked, write_recording

TITLE = "PAL TIAGo, currents of its arm's motors"
LEFT_OUT = "all friction, rotors"
FOLDER = "pal_tiago"
ANGLES, CURRENTS, MODEL = "tiago_position.csv", "tiago_effort.csv", "tiago_48_schunk.urdf"
FILES = [ANGLES, CURRENTS, MODEL]
JOINTS = ["torso_lift", *(f"arm_{number}" for number in range(1, 8))]
BASE, TIP = "torso_fixed_link", "arm_7_link"

TORQUE_OF_CURRENT = {1: 100 * 0.136, 2: 100 * 0.136, 3: -100 * 0.087, 4: -100 * 0.087}  # N·m/A, by column
BEGIN, END = 9.2, 67.9  # s, between which it moves
TRAINING_PART = 0.7


def read(folder):
    """Time (n,) s, angles (n, 8) rad and m, torques (n, 8) N·m, not-a-number where no motor reports one."""
    (time, angle), (again, current) = (_read(folder / file, kind) for file, kind in
                                       ((ANGLES, "position"), (CURRENTS, "effort")))
    if not np.array_equal(time, again):
        raise Damaged(f"{folder / CURRENTS}: its times are not those of {ANGLES}")
    torque = np.full(angle.shape, np.nan)
    for column, factor in TORQUE_OF_CURRENT.items():
        torque[:, column] = factor * current[:, column]
    moves = (time >= BEGIN) & (time <= END)
    if not moves.any():
        raise Damaged(f"{folder / ANGLES}: no rows between {BEGIN} and {END} s")
    return time[moves] - time[moves][0], angle[moves], torque[moves]


def _read(path, kind):
    form = "- {}_joint_" + kind
    table = read_table(path, ["t", *(form.format(joint) for joint in JOINTS)], rising="t")
    return table["t"], stacked(table, form, JOINTS)


def write(data, folder):
    """One experiment: the last three tenths of the motion are held out."""
    model = write_robot(folder, read_chain(data / MODEL, "PAL TIAGo", BASE, TIP))
    time, angle, torque = read(data)
    is_training = time <= TRAINING_PART * time[-1]
    training, held_out = (
        write_recording(folder / f"{name}.csv", time[rows], q_meas=angle[rows], tau=torque[rows])
        for name, rows in (("training", is_training), ("held_out", ~is_training)))
    return [Experiment("torques", model, [training], held_out)]
