"""Hilti JaiBot: a six-axis arm on a lifting column on tracks, seen by a total station.

Recording: github.com/Hilti-Research/construction_robot_stationing_datasets, commit f26546d (CC
BY-NC-SA 3.0): static poses with joint readings, the place of a prism on the tool (0.75 mm), and
accelerometers in the base and at the column's top. Sites: `flat`, a hard floor, and `pallet`,
wooden pallets.

The six joints are the arm's. At one height, base and column are one rigid body below it, whose foot
is the model's base, so that its giving way shows as `base_compliance`. Other heights are other
models, because seven axes do not fit into six joints: here it is the tallest, where the column
gives most. Geometry and masses are the CAD's. Left out: all that bends, and this very arm's
calibration; one branch of the arm's inverse kinematics, that with most poses, because its geometry
errs by millimetres between them.

Where the total station stood is not known: its frame is fitted, without scale, to the rigid model
in the poses to learn from. That takes along the part of the tilt that all poses share.
"""

import numpy as np

from ..geometry import rigid_fit
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import write_recording
from . import cad, poses

TITLE = "Hilti JaiBot, an arm on a column"
LEFT_OUT = "compliance of base and column, calibration of the arm"
FOLDER = "hilti_jaibot"
SITES = ("flat", "pallet")
FILES = ["trailblazer.urdf", *(f"{site}.yaml" for site in SITES)]

HEIGHT = 3.87  # m
BRANCH = 7


def write(data, folder):
    """An experiment a site; the second of every four poses is held out."""
    return [_write_site(data, folder / site, site) for site in SITES]


def _write_site(data, folder, site):
    found = poses.read(data / f"{site}.yaml", HEIGHT, BRANCH)
    chain = cad.Cad(data / "trailblazer.urdf").chain(f"JaiBot {site}", float(found.column.mean()))
    model = write_robot(folder, chain)
    rigid = np.array([chain.frames(angles)[-1].position for angles in found.arm])
    is_held_out = np.arange(len(rigid)) % 4 == 1
    rotation, shift = rigid_fit(rigid[~is_held_out], found.prism[~is_held_out])
    position = (found.prism - shift) @ rotation
    training, held_out = (
        write_recording(folder / f"{name}.csv", np.arange(rows.sum()), q_cmd=found.arm[rows],
                        xyz=position[rows])
        for name, rows in (("poses", ~is_held_out), ("held_out", is_held_out)))
    return Experiment(site, model, [training], held_out)
