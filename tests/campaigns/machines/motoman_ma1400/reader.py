"""Yaskawa Motoman MA1400: two arms on one turntable, each seen by a laser tracker.

Recording: K. Stepanova, J. Rozlivek and others, "Automatic self-contained calibration of an industrial dual-arm
robot with cameras using self-contact, planar constraints, and self-observation", Robotics and
Computer-Integrated Manufacturing 73, 2022; github.com/ctu-vras/multirobot-calibration, commit a20f045 (LGPL-3),
UserData/Robots/Motoman/Dataset/leica_dataset. Geometry and reflectors are that toolbox's (loadMotomanLeica.m),
which are the data sheet's. No link's mass is published: those here are estimates that add up to what stands on
the turntable of an arm of 130 kg.

The turntable stands still and is part of the base. All poses of an arm have one orientation, within 0.2 degrees,
so that where the reflector is cannot be told from where the tracker stood. The tracker's frame is fitted, without
scale, to the model in the poses to learn from.
"""

import math

import numpy as np
import scipy.io

from ..chain import JOINTS, Body, Chain, Joint, by_standard_parameters
from ..geometry import moved, rigid_fit, turned
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import Damaged, write_recording

TITLE = "Yaskawa Motoman MA1400, two arms, laser tracker"
LEFT_OUT = "its calibration (zeros, lengths, axes), springs of the joints"
FOLDER = "motoman_ma1400"
ARMS = ("right", "left")
FILES = [f"leica_{arm}_hand_6x6x6_dataset.mat" for arm in ARMS]
EVERY = 4  # poses: the last of so many is held out

# Columns of the tables, as their description counts them from 0.
POSE, TURNTABLE, SEEN, WIDTH = 0, 6, slice(19, 22), 26
ANGLES = {"right": slice(7, 13), "left": slice(13, 19)}

# a (m), d (m), alpha, angle where the joint's own is zero.
TILT = {"right": math.radians(15), "left": math.radians(-15)}
COLUMN = -0.263  # m, d of the turntable
LINKS = ((0.150, 1.4159, -math.pi / 2), (0.614, 0.0, math.pi), (0.200, 0.0, -math.pi / 2),
         (0.0, -0.640, math.pi / 2), (0.030, 0.0, math.pi / 2), (0.0, 0.200, 0.0))
ZEROS = (0.0, -math.pi / 2, 0.0, 0.0, -math.pi / 2, 0.0)
REFLECTORS = {"right": turned("z", -0.38) @ moved(0.045, 0.0, 0.245), "left": moved(0.050, 0.0, 0.250)}
# Estimates, in the frames at the links' far ends.
BODIES = (Body(45.0, np.array([-0.1, 0.05, 0.0])), Body(22.0, np.array([-0.3, 0.0, 0.0])),
          Body(25.0, np.array([0.0, 0.0, 0.05])), Body(9.0, np.array([0.0, 0.25, 0.0])),
          Body(3.0, np.zeros(3)), Body(4.0, np.array([0.0, 0.0, 0.08])))


def chain(arm, turntable):
    """An arm, the turntable at an angle (rad)."""
    base = (turned("z", turntable - math.pi / 2) @ moved(z=COLUMN) @ turned("x", TILT[arm]))
    places, ends = by_standard_parameters(LINKS, base, ZEROS)
    joints = [Joint(place, [body.seen_from(end)]) for place, end, body in zip(places, ends, BODIES)]
    return Chain(f"Motoman MA1400 {arm}", joints, tool=ends[-1] @ REFLECTORS[arm])


def read(path, arm):
    """Angles (n, 6) rad, the reflector in the tracker's frame (n, 3) m, a row a pose, and the turntable's angle."""
    try:
        table = np.asarray(scipy.io.loadmat(path)["dataset"], float)
    except Exception as error:  # of a damaged file loadmat raises whatever happens to it
        raise Damaged(f"{path}: no table 'dataset' of MATLAB: {error}") from error
    if table.ndim != 2 or table.shape[1] != WIDTH:
        raise Damaged(f"{path}: expected {WIDTH} columns, found {' by '.join(map(str, table.shape))}")
    poses = table[np.unique(table[:, POSE], return_index=True)[1]]  # a row a marker that a camera saw
    used = np.hstack([poses[:, [TURNTABLE]], poses[:, ANGLES[arm]], poses[:, SEEN]])
    used = used[np.isfinite(used).all(axis=1)]
    if len(used) < 2 * EVERY:
        raise Damaged(f"{path}: {len(used)} poses that were seen, expected {2 * EVERY} or more")
    return used[:, 1:1 + JOINTS], used[:, 1 + JOINTS:], float(used[:, 0].mean())


def write(data, folder):
    """An experiment an arm; every fourth pose is held out."""
    return [_write_arm(data / file, folder / arm, arm) for file, arm in zip(FILES, ARMS)]


def _write_arm(path, folder, arm):
    angles, seen, turntable = read(path, arm)
    robot = chain(arm, turntable)
    model = write_robot(folder, robot)
    rigid = np.array([robot.frames(each)[-1].position for each in angles])
    is_held_out = np.arange(len(angles)) % EVERY == EVERY - 1
    rotation, shift = rigid_fit(rigid[~is_held_out], seen[~is_held_out])
    position = (seen - shift) @ rotation
    training, held_out = (
        write_recording(folder / f"{name}.csv", np.arange(rows.sum()), q_cmd=angles[rows], xyz=position[rows])
        for name, rows in (("poses", ~is_held_out), ("held_out", is_held_out)))
    return Experiment(arm, model, [training], held_out)
