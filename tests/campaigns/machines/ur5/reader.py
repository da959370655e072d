"""Universal Robots UR5: a thousand poses commanded, and where a laser tracker saw it.

Recording: P. Jacobi, Master's thesis, Tsinghua University 2025,
github.com/pauljac7700/serial_robots_datasets, commit 759068d (MIT): target positions, errors,
commanded joint angles; tracker GTS3800, 15 µm + 6 µm/m.

Frame: the target is, within 7 µm, the manufacturer's kinematics of the commanded angles in its own
base frame, with the reflector's centre 31 mm in front of the flange. Sign: upstream does not state
whether the error is added to the target; kinematics cannot tell, but weight can. With position =
target + error the shoulder gives along its load, 3.4e-5 rad/(N·m) ± 6 %, with the other sign
against it; so it is added.

The model has the manufacturer's public kinematics, masses and centres of mass, and rigid joints.
Left out: this very robot's calibration, the springs of its joints, reflector and mount,
temperature.
"""

import math

import numpy as np

from ..chain import JOINTS, Body, Chain, Joint, by_standard_parameters
from ..geometry import Frame, moved
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import read_table, stacked, write_recording

TITLE = "Universal Robots UR5, laser tracker"
LEFT_OUT = "its calibration (frame, zeros, lengths, axes), springs of the joints"
FOLDER = "ur5_wam_pose_errors/UR5"
GRID, RANDOM = "3D_UR5_uncalibrated_grid_cleaned.csv", "3D_UR5_uncalibrated_random_cleaned.csv"
FILES = [GRID, RANDOM]
COLUMNS = ([f"{axis}_{kind}" for kind in ("t", "dif") for axis in "xyz"]
           + [f"joint_{joint}" for joint in range(1, JOINTS + 1)])
STRETCH = 50  # poses: every fourth stretch of the grid is held out

# a (m), d (m), alpha; masses (kg) with their centres (m) in the frames at the links' far ends.
LINKS = ((0.0, 0.089159, math.pi / 2), (-0.425, 0.0, 0.0), (-0.39225, 0.0, 0.0),
         (0.0, 0.10915, math.pi / 2), (0.0, 0.09465, -math.pi / 2), (0.0, 0.0823, 0.0))
BODIES = (Body(3.7, np.array([0.0, -0.02561, 0.00193])),
          Body(8.393, np.array([0.2125, 0.0, 0.11336])),
          Body(2.275, np.array([0.15, 0.0, 0.0265])),
          Body(1.219, np.array([0.0, -0.0018, 0.01634])),
          Body(1.219, np.array([0.0, 0.0018, 0.01634])),
          Body(0.1879, np.array([0.0, 0.0, -0.001159])))
REFLECTOR = (-0.01e-3, 0.07e-3, 31.0e-3)  # m, from the flange


def chain():
    places, ends = by_standard_parameters(LINKS, Frame())
    joints = [Joint(place, [body.seen_from(end)]) for place, end, body in zip(places, ends, BODIES)]
    return Chain("UR5", joints, tool=ends[-1] @ moved(*REFLECTOR))


def read(path):
    """Commanded angles (n, 6) rad and measured positions (n, 3) m in the base frame, a row a
    pose."""
    table = read_table(path, COLUMNS)
    angles = np.radians(stacked(table, "joint_{}", range(1, JOINTS + 1)))
    return angles, 1e-3 * (stacked(table, "{}_t", "xyz") + stacked(table, "{}_dif", "xyz"))


def write(data, folder):
    """One experiment: three quarters of the grid to learn from; its rest and the random poses held
    out."""
    model = write_robot(folder, chain())
    angles, position = read(data / GRID)
    random_angles, random_position = read(data / RANDOM)
    is_held_out = np.arange(len(angles)) // STRETCH % 4 == 3
    training = write_recording(folder / "grid.csv", np.arange((~is_held_out).sum()),
                               q_cmd=angles[~is_held_out], xyz=position[~is_held_out])
    checked = np.vstack([angles[is_held_out], random_angles])
    held_out = write_recording(folder / "held_out.csv", np.arange(len(checked)), q_cmd=checked,
                               xyz=np.vstack([position[is_held_out], random_position]))
    return [Experiment("positions", model, [training], held_out)]
