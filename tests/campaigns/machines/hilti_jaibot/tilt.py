"""Tilt of base and column by the accelerometers: a witness that the diagnosis does not hear."""

import numpy as np

from . import cad, poses, reader

GRAVITY = 9.81  # m/s²


def moments(chain, arm):
    """Moments (n, 2) about the foot's x and y, N·m, of the weights of the arm at angles (n, 6)."""
    found = []
    for angles in arm:
        frames = chain.frames(angles)
        found.append(sum(
            np.cross(frame.at(body.center), [0.0, 0.0, -GRAVITY * body.mass])[:2]
            for frame, joint in zip(frames, chain.joints) for body in joint.bodies))
    return np.array(found)


def springs(data, site):
    """Tilt about x and y by moment about it, rad/(N·m): {"base": (2,), "top of the column":
    (2,)}."""
    found = poses.read(data / f"{site}.yaml", reader.HEIGHT, reader.BRANCH)
    chain = cad.Cad(data / "trailblazer.urdf").chain(site, float(found.column.mean()))
    moment = moments(chain, found.arm)
    answers = {}
    for place, force in (("base", found.base_force), ("top of the column", found.top_force)):
        # At rest a sensor turned by small angles reads gravity's reaction (-turn_y, turn_x, 1) g.
        tilt = np.column_stack([force[:, 1], -force[:, 0]]) / GRAVITY
        answers[place] = np.array([np.polyfit(moment[:, axis], tilt[:, axis], 1)[0]
                                   for axis in (0, 1)])
    return answers
