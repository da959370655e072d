"""Where the links are, for many samples at once."""

import dataclasses

import numpy as np

from .robot import JOINTS, rotation_about

BASE, TOOL = 0, JOINTS + 1  # places of springs beside the links 1 to 6


@dataclasses.dataclass
class Posture:
    """n samples, base frame. Entry k-1 of the joint arrays is link k's frame, at joint k."""

    rotation: np.ndarray  # (6, n, 3, 3)
    origin: np.ndarray  # (6, n, 3)
    axis: np.ndarray  # (6, n, 3)
    tool_rotation: np.ndarray  # (n, 3, 3)
    tcp: np.ndarray  # (n, 3)


def turn(rotation, vector):
    """(n, 3, 3) or (3, 3), and (n, 3) or (3,) -> (n, 3)."""
    return np.matmul(rotation, vector[..., None])[..., 0]


def cross(a, b):
    """Vector product over the last axis; numpy's own spends most of its time on generality."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], -1)


def small_rotation(vector):
    """The rotation by a rotation vector (n, 3)."""
    angle = np.linalg.norm(vector, axis=-1)
    skew = np.zeros(vector.shape[:-1] + (3, 3))
    x, y, z = vector[..., 0], vector[..., 1], vector[..., 2]
    skew[..., 0, 1], skew[..., 0, 2], skew[..., 1, 2] = -z, y, -x
    skew[..., 1, 0], skew[..., 2, 0], skew[..., 2, 1] = z, -y, x
    sinc = np.sinc(angle / np.pi)[..., None, None]
    half = 0.5 * np.sinc(angle / (2 * np.pi))[..., None, None] ** 2
    return np.eye(3) + sinc * skew + half * (skew @ skew)


def _give(rotation, position, give):
    """Moves a frame by a spring's give (n, 6): translation, then rotation vector, in that frame."""
    return rotation @ small_rotation(give[:, 3:]), position + turn(rotation, give[:, :3])


def posture(robot, q, gives=None):
    """q (n, 6) rad -> Posture. gives: {place: (n, 6)}, how far the springs of base (0), link 1 to 6
    (at the link's root, in its frame) and tool (7) have given."""
    gives = gives or {}
    n = len(q)
    rotation, position = np.broadcast_to(np.eye(3), (n, 3, 3)), np.zeros((n, 3))
    if BASE in gives:
        rotation, position = _give(rotation, position, gives[BASE])
    rotations, origins, axes = [], [], []
    for k in range(JOINTS):
        position = position + turn(rotation, robot.origin[k])
        rotation = rotation @ robot.origin_rotation[k]
        axes.append(turn(rotation, robot.axis[k]))
        rotation = rotation @ rotation_about(robot.axis[k], q[:, k])
        if k + 1 in gives:
            rotation, position = _give(rotation, position, gives[k + 1])
        rotations.append(rotation)
        origins.append(position)
    tcp = position + turn(rotation, robot.tool)
    tool_rotation = rotation @ robot.tool_rotation
    if TOOL in gives:
        tool_rotation, tcp = _give(tool_rotation, tcp, gives[TOOL])
    return Posture(np.array(rotations), np.array(origins), np.array(axes), tool_rotation, tcp)


def jacobian(place):
    """Posture -> (n, 6, 6): rows linear then angular velocity of the TCP, a column a joint."""
    linear = cross(place.axis, place.tcp - place.origin)
    return np.moveaxis(np.concatenate([linear, place.axis], axis=2), 0, 2)
