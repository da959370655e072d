"""Rotations and frames."""

import dataclasses

import numpy as np


def turn(axis, angle):
    """Rotation matrix (3, 3) about a unit vector by an angle in rad (Rodrigues' formula)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def rotation_of(rpy):
    """URDF's roll, pitch, yaw about fixed axes (rad) -> (3, 3)."""
    roll, pitch, yaw = rpy
    return turn((0, 0, 1), yaw) @ turn((0, 1, 0), pitch) @ turn((1, 0, 0), roll)


def rpy_of(rotation):
    """The inverse of `rotation_of`; upright or upside down, where roll and yaw are one, yaw is
    zero."""
    level = float(np.hypot(rotation[0, 0], rotation[1, 0]))
    pitch = float(np.arctan2(-rotation[2, 0], level))
    if level < 1e-9:
        return float(np.arctan2(-rotation[1, 2], rotation[1, 1])), pitch, 0.0
    return (float(np.arctan2(rotation[2, 1], rotation[2, 2])), pitch,
            float(np.arctan2(rotation[1, 0], rotation[0, 0])))


@dataclasses.dataclass
class Frame:
    """Where a frame lies, seen from another: rotation (3, 3) and position (3,) in m."""

    rotation: np.ndarray = dataclasses.field(default_factory=lambda: np.eye(3))
    position: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(3))

    def __matmul__(self, then):
        return Frame(self.rotation @ then.rotation, self.at(then.position))

    def at(self, point):
        """A point of this frame, (3,) in m, seen from the other."""
        return self.position + self.rotation @ np.asarray(point, float)


def moved(x=0.0, y=0.0, z=0.0):
    return Frame(position=np.array([x, y, z], float))


def turned(axis, angle):
    """axis: x, y or z; angle in rad."""
    return Frame(turn(np.eye(3)["xyz".index(axis)], angle))


def rigid_fit(model, seen):
    """Rotation (3, 3) and shift (3,) that take points (n, 3) of the model to those seen (n, 3),
    with least squares (Arun, Huang and Blostein 1987)."""
    middle, seen_middle = model.mean(axis=0), seen.mean(axis=0)
    u, _, v = np.linalg.svd((model - middle).T @ (seen - seen_middle))
    rotation = v.T @ np.diag([1, 1, np.linalg.det(v.T @ u.T)]) @ u.T
    return rotation, seen_middle - rotation @ middle
