"""Natural frequencies of the robot on its joint springs, motors held."""

import mujoco
import numpy as np
from scipy.linalg import eigh

from plant import assembly

ALONE = 0.98  # of a mode's elastic energy, in one spring
SLOWEST = 15.0  # Hz: above, a tracker sees too little


def single_joint_modes(description, posture):
    """{joint: (Hz, direction (3,) in which the TCP swings)} of the slow modes in which one spring
    holds nearly all of the elastic energy."""
    model = assembly.rigid(description)
    data = mujoco.MjData(model)
    data.qpos[:] = posture
    mujoco.mj_forward(model, data)
    mass = np.zeros((6, 6))
    mujoco.mj_fullM(model, data, mass)
    lever = np.zeros((3, 6))
    mujoco.mj_jacSite(model, data, lever, None, model.site("tcp").id)
    stiffness = 1 / description.column("compliance")
    squares, shapes = eigh(np.diag(stiffness), mass)
    found = {}
    for square, shape in zip(squares, shapes.T):
        energy = stiffness * shape**2
        joint, frequency = int(np.argmax(energy)) + 1, float(np.sqrt(square)) / (2 * np.pi)
        if energy.max() > ALONE * energy.sum() and frequency < SLOWEST:
            way = lever @ shape
            found.setdefault(joint, (frequency, way / np.linalg.norm(way)))
    return found
