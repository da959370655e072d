"""The bent robot at rest: springs in equilibrium with wrench and weights."""

import dataclasses

import numpy as np

from .dynamics import about_axes, beyond, weights
from .kinematics import BASE, TOOL, cross, posture
from .robot import JOINTS

ROUNDS, SETTLED = 8, 1e-9  # a round takes the error (rad) down by about 1e-3


@dataclasses.dataclass
class Spring:
    """Gives by compliance (6, 6) times the wrench on it, both in the frame of its place."""

    place: int  # 0 base, 1 to 6 root of that link, 7 tool
    compliance: np.ndarray


def model_springs(robot):
    """The springs of base and tool that the robot's YAML has."""
    pairs = ((BASE, robot.base_compliance), (TOOL, robot.tool_compliance))
    return [Spring(place, np.diag(entries)) for place, entries in pairs if entries.any()]


def beam(length_vector, bending):
    """Compliance (6, 6) at its root, in the link's frame, of a link that is a cantilever of the given
    vector (m); bending = length/EI in rad/(N·m), the tip's turn by a moment. Euler and Bernoulli."""
    length = np.linalg.norm(length_vector)
    along = length_vector / length
    across = np.eye(3) - np.outer(along, along)
    x, y, z = length_vector
    lever = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    # At mid-length force and moment do not mix; there the beam gives by length^3/(12 EI) as well.
    middle = np.zeros((6, 6))
    middle[:3, :3] = bending * length**2 / 12 * across
    middle[3:, 3:] = bending * across
    carry = np.eye(6)
    carry[:3, 3:] = 0.5 * lever  # displacement at the root-fixed point of a turn about mid-length
    return carry @ middle @ carry.T


def loads(robot, place, wrench):
    """Effect of the wrench on the TCP (n, 6) and the weights on link k and all beyond: force and
    moment about the base origin, each (6, n, 3)."""
    force, moment = weights(robot, place)
    force[-1] += wrench[:, :3]
    moment[-1] += wrench[:, 3:] + cross(place.tcp, wrench[:, :3])
    return beyond(force, moment)


def _gives(springs, place, wrench, force, moment):
    gives = {}
    for spring in springs:
        if spring.place == TOOL:
            rotation, pull, twist = place.tool_rotation, wrench[:, :3], wrench[:, 3:]
        elif spring.place == BASE:
            rotation, pull, twist = np.eye(3), force[0], moment[0]
        else:
            k = spring.place - 1
            rotation, pull = place.rotation[k], force[k]
            twist = moment[k] - cross(place.origin[k], force[k])
        back = np.swapaxes(np.broadcast_to(rotation, (len(wrench), 3, 3)), 1, 2)
        local = np.concatenate([(back @ pull[..., None])[..., 0], (back @ twist[..., None])[..., 0]], 1)
        gives[spring.place] = gives.get(spring.place, 0) + local @ spring.compliance.T
    return gives


def settle(robot, springs, q, wrench, balance=None):
    """Posture and wind-up (n, 6) of the robot whose motors stand at q.

    wrench (n, 6) on the tool, base frame. balance(q_link) -> (n, 6): torque between neighbouring
    links, in parallel to the drives (a gravity compensator).
    """
    windup, gives = np.zeros((len(q), JOINTS)), {}
    for _ in range(ROUNDS):
        place = posture(robot, q + windup, gives)
        force, moment = loads(robot, place, wrench)
        torque = about_axes(place, force, moment)
        if balance is not None:
            torque = torque + balance(q + windup)
        before, windup = windup, robot.compliance * torque + robot.cubic * torque**3
        gives = _gives(springs, place, wrench, force, moment)
        if np.abs(windup - before).max() < SETTLED:
            break
    return posture(robot, q + windup, gives), windup
