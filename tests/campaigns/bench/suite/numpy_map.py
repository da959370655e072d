"""The study's map of a robot with NumPy: how many path points a second, and the map itself.

What it does is what map_speed.cpp does: circles of 72 points about the nodes of a grid, the arm's
closed-form inverse kinematics, C w = J K⁻¹ Jᵀ w at each point, the least-squares circularity.
Everything is done for many circles at a time, as one does with NumPy.
"""

import json
import sys
import time
import xml.etree.ElementTree

import numpy as np
import yaml

POINTS = 72
RADIUS = 0.1  # m
FORCE = np.array([440, 1370, 635])  # N: out of the circle, along the feed, along -y
MOMENT = np.array([0, 3, 10.5])  # N·m, in the same directions


class Robot:
    def __init__(self, folder):
        settings = yaml.safe_load((folder / "robot.yaml").read_text())
        urdf = xml.etree.ElementTree.parse(folder / settings["urdf"]).getroot()
        joints = [joint for joint in urdf.iter("joint") if joint.get("type") == "revolute"]
        self.origins = np.array([[float(v) for v in joint.find("origin").get("xyz").split()] for joint in joints])
        self.axes = np.array([[float(v) for v in joint.find("axis").get("xyz").split()] for joint in joints])
        self.compliance = np.array([settings["joints"][joint.get("name")]["compliance"] for joint in joints])

    def deflection(self, q, force, moment):
        """Deflection of the origin of joint 5, m; q (n, 6), force and moment (n, 3)."""
        rotation = np.broadcast_to(np.eye(3), (len(q), 3, 3))
        position = np.zeros((len(q), 3))
        places, axes = [], []
        for joint in range(5):
            position = position + rotation @ self.origins[joint]
            axes.append(rotation @ self.axes[joint])
            places.append(position)
            rotation = rotation @ rotations(self.axes[joint], q[:, joint])
        axis = np.array(axes)
        lever = position - np.array(places)
        jacobian = np.concatenate([np.cross(axis, lever), axis], axis=2)  # joints, n, 6
        wrench = np.concatenate([force, moment], axis=1)
        wind_up = self.compliance[:5, None] * np.einsum("jni,ni->jn", jacobian, wrench)
        return np.einsum("jni,jn->ni", jacobian, wind_up)[:, :3]


def rotations(axis, angle):
    """About an axis of the frame, by Rodrigues's formula; (n, 3, 3)."""
    across = np.cross(np.eye(3), axis)
    c = np.cos(angle)[:, None, None]
    s = np.sin(angle)[:, None, None]
    return c * np.eye(3) + s * across + (1 - c) * np.outer(axis, axis)


def angles(robot, x, z):
    """Closed form, elbow up; NaN where out of reach. (n, 6)"""
    shoulder = robot.origins[0] + robot.origins[1]
    upper = robot.origins[2][0]
    fore = robot.origins[3] + robot.origins[4]
    length = np.hypot(fore[0], fore[2])
    reach = (x - shoulder[0]) + 1j * (z - shoulder[2])
    square = np.abs(reach) ** 2
    with np.errstate(invalid="ignore"):
        along = (upper**2 - length**2 + square) / (2 * square)
        elbow = reach * (along + 1j * np.sqrt(upper**2 / square - along**2))
    q = np.zeros((len(x), 6))
    q[:, 1] = -np.angle(elbow)  # axis 2 turns x to -z
    q[:, 2] = -np.angle((reach - elbow) / elbow / complex(fore[0], fore[2]))
    q[np.isnan(elbow)] = np.nan
    return q


def circularity(x, y):
    """Least squares, Newton's method; rows are profiles about the origin, m."""
    cx = np.zeros((len(x), 1))
    cy = np.zeros((len(x), 1))
    for _ in range(4):
        u, v = x - cx, y - cy
        distance = np.hypot(u, v)
        u, v = u / distance, v / distance
        error = distance - distance.mean(1, keepdims=True)
        bend = error / distance
        total_u, total_v = u.sum(1), v.sum(1)
        gx, gy = (error * u).sum(1), (error * v).sum(1)
        uu = (u * u + bend * v * v).sum(1) - total_u**2 / POINTS
        vv = (v * v + bend * u * u).sum(1) - total_v**2 / POINTS
        uv = ((1 - bend) * u * v).sum(1) - total_u * total_v / POINTS
        determinant = uu * vv - uv * uv
        cx[:, 0] += (vv * gx - uv * gy) / determinant
        cy[:, 0] += (uu * gy - uv * gx) / determinant
    distance = np.hypot(x - cx, y - cy)
    return distance.max(1) - distance.min(1)


def map_of(robot, x, z):
    """m, of the circles about (x, z); NaN where out of reach."""
    angle = np.arange(POINTS) * 2 * np.pi / POINTS
    c, s = np.cos(angle), np.sin(angle)
    q = angles(robot, (x[:, None] + RADIUS * c).ravel(), (z[:, None] + RADIUS * s).ravel())

    def turned(out, along, across):
        one = np.stack([out * c - along * s, np.full(POINTS, -across), out * s + along * c], axis=1)
        return np.tile(one, (len(x), 1))

    moved = robot.deflection(q, turned(*FORCE), turned(*MOMENT))
    shape = (len(x), POINTS)
    return circularity(RADIUS * c + moved[:, 0].reshape(shape), RADIUS * s + moved[:, 2].reshape(shape))


def measure(folder, nodes, together):
    """Over the nodes (x, z, m), so many at a time: points per second and the largest difference from
    the circularities (m) that come with the nodes."""
    robot = Robot(folder)
    x, z, expected = np.array(nodes).T
    start = time.process_time()
    found = np.concatenate([map_of(robot, x[i:i + together], z[i:i + together])
                            for i in range(0, len(x), together)])
    elapsed = time.process_time() - start
    return POINTS * len(x) / elapsed, np.abs(found - expected).max()
