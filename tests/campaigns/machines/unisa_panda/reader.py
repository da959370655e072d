"""Another Franka Emika Panda: an exciting motion with the torques of its sensors, thirty rows a second.

Recording: V. Petrone, E. Ferrentino, P. Chiacchio, University of Salerno;
github.com/unisa-acg/inverse-dynamics-solver, commit 41e196d (BSD-3-Clause), a ROS 2 bag. The model is that of the
first one (franka_panda/reader.py): masses identified on yet another robot of this kind.

The model leaves out all friction, and what this robot's masses differ by.
"""

from .. import joint_states
from ..franka_panda import reader as another

TITLE = "Franka Emika Panda of another laboratory"
LEFT_OUT = "all friction, what its masses differ by"
FOLDER = "unisa_panda"
RECORDING = "panda_exciting_trajectory.csv"
FILES = [RECORDING]
TRAINING_PART = 0.7


def write(data, folder):
    """One experiment: the last three tenths of the motion are held out."""
    return joint_states.write(data / RECORDING, folder, another.chain(), TRAINING_PART)
