"""Forces on the links: Newton and Euler for every body, in the base frame."""

import numpy as np

from .kinematics import cross, posture, turn
from .robot import JOINTS


def weights(robot, place):
    """Weight of all links in a posture: forces (6, n, 3) and moments about the base origin (6, n, 3)."""
    n = place.tcp.shape[0]
    force, moment = np.zeros((JOINTS, n, 3)), np.zeros((JOINTS, n, 3))
    if not robot.gravity.any():
        return force, moment
    for k, bodies in enumerate(robot.bodies):
        for body in bodies:
            com = place.origin[k] + turn(place.rotation[k], body.com)
            weight = np.broadcast_to(body.mass * robot.gravity, (n, 3))
            force[k] += weight
            moment[k] += cross(com, weight)
    return force, moment


def beyond(force, moment):
    """Force and moment on link k and everything after it, for all k: sums from the tip."""
    return np.cumsum(force[::-1], axis=0)[::-1], np.cumsum(moment[::-1], axis=0)[::-1]


def about_axes(place, force, moment):
    """Moments about the joint axes (n, 6) of forces, and moments about the base origin, beyond them."""
    at_joint = moment - cross(place.origin, force)
    return np.einsum("kni,kni->nk", place.axis, at_joint)


def inverse_dynamics(robot, q, velocity, acceleration, gravity=True):
    """Torque (n, 6) that makes the rigid robot move so; friction, rotors and wrench left out."""
    place = posture(robot, q)
    n = len(q)
    omega, alpha, linear = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    previous = np.zeros((n, 3))
    force, moment = np.zeros((JOINTS, n, 3)), np.zeros((JOINTS, n, 3))
    for k in range(JOINTS):
        step = place.origin[k] - previous
        linear = linear + cross(alpha, step) + cross(omega, cross(omega, step))
        previous = place.origin[k]
        spin = place.axis[k] * velocity[:, k, None]
        alpha = alpha + place.axis[k] * acceleration[:, k, None] + cross(omega, spin)
        omega = omega + spin
        for body in robot.bodies[k]:
            lever = turn(place.rotation[k], body.com)
            centre = linear + cross(alpha, lever) + cross(omega, cross(omega, lever))
            if gravity:
                centre = centre - robot.gravity
            tensor = place.rotation[k] @ body.inertia @ np.swapaxes(place.rotation[k], 1, 2)
            pull = body.mass * centre
            force[k] += pull
            moment[k] += (turn(tensor, alpha) + cross(omega, turn(tensor, omega))
                          + cross(place.origin[k] + lever, pull))
    return about_axes(place, *beyond(force, moment))
