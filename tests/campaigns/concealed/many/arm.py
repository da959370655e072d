"""The rigid arm in NumPy, many rows at once: places, levers, and what each link's mass does.

Apart from the engine of the plant, so that a slip in one shows in the other.
"""

import numpy as np

NUMBERS = 10  # of a rigid body: mass, first moments (3), inertia about the link's origin (6)
PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


def rotations(axis, angle):
    """(n, 3, 3) about one axis (3,) by angles (n,)."""
    x = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    sine, cosine = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + sine * x + (1 - cosine) * (x @ x)


def small_turn(vector):
    """(3, 3) by a rotation vector (3,)."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    return rotations(vector / angle, np.array([angle]))[0]


class Frames:
    """Where the links of rows of joint angles stand, in the base frame."""

    def __init__(self, chain, q):
        """chain: of plant.description.Joint; q: (n, 6) rad."""
        n = len(q)
        turn, place = np.broadcast_to(np.eye(3), (n, 3, 3)), np.zeros((n, 3))
        self.axes, self.origins, self.turns, self.places = [], [], [], []
        number = 0
        for joint in chain:
            place = place + turn @ joint.position
            turn = turn @ joint.rotation
            if joint.axis is not None:
                self.axes.append(turn @ joint.axis)
                self.origins.append(place)
                turn = turn @ rotations(joint.axis, q[:, number])
                number += 1
            self.turns.append(turn)
            self.places.append(place)
        self.tip, self.tool = place, turn

    def load(self, chain, gravity, payload, wrench=None):
        """(n, 6) N·m that weights and a wrench on the tip exert on the joints.

        payload: (mass, com (3,) in the tool frame); wrench: (n, 6), base frame."""
        torque = np.zeros((len(self.tip), len(self.axes)))
        number = 0
        for joint, turn, place in zip(chain, self.turns, self.places):
            number += joint.axis is not None
            if joint.body is not None and joint.body.mass:
                center = place + turn @ joint.body.center
                self._add(torque, number, center, joint.body.mass * gravity)
        mass, center = payload
        if mass:
            self._add(torque, len(self.axes), self.tip + self.tool @ center, mass * gravity)
        if wrench is not None:
            self._add(torque, len(self.axes), self.tip, wrench[:, :3])
            for k, axis in enumerate(self.axes):
                torque[:, k] += (axis * wrench[:, 3:]).sum(1)
        return torque

    def _add(self, torque, carrying, point, force):
        for k in range(carrying):
            torque[:, k] += (self.axes[k] * np.cross(point - self.origins[k], force)).sum(1)


def standard_numbers(body):
    """(10,) of a plant.description.Body."""
    first = body.mass * body.center
    about = body.inertia + body.mass * (body.center @ body.center * np.eye(3)
                                        - np.outer(body.center, body.center))
    return np.array([body.mass, *first, *(about[pair] for pair in PAIRS)])


def lumped(chain):
    """The chain's bodies by moving link: (6, 10), those behind fixed joints carried over."""
    found, number = np.zeros((6, NUMBERS)), 0
    turn, place = np.eye(3), np.zeros(3)
    for joint in chain:
        if joint.axis is not None:
            number += 1
            turn, place = np.eye(3), np.zeros(3)
        else:
            place, turn = place + turn @ joint.position, turn @ joint.rotation
        if joint.body is not None and number:
            body = type(joint.body)(joint.body.mass, place + turn @ joint.body.center,
                                    turn @ joint.body.inertia @ turn.T)
            found[number - 1] += standard_numbers(body)
    return found


def point_mass(chain, mass, center):
    """(10,) of a point in the tool frame, as part of the last moving link."""
    turn, place = np.eye(3), np.zeros(3)
    last = max(k for k, joint in enumerate(chain) if joint.axis is not None)
    for joint in chain[last + 1:]:
        place, turn = place + turn @ joint.position, turn @ joint.rotation
    point = place + turn @ np.asarray(center, float)
    return mass * np.array([1, *point, *(float(point @ point * (i == j) - point[i] * point[j])
                                         for i, j in PAIRS)])


def _cross(a, b):
    return np.cross(a, b, axis=-1)


def _moment_columns(turn, spin, change):
    """(n, 3, 6): dH/dt of a body by the six numbers of its inertia (link frame)."""
    columns = np.empty((len(spin), 3, 6))
    for c, (i, j) in enumerate(PAIRS):
        unit = np.zeros((3, 3))
        unit[i, j] = unit[j, i] = 1
        tensor = turn @ unit @ turn.transpose(0, 2, 1)
        columns[:, :, c] = (np.einsum("nij,nj->ni", tensor, change)
                            + _cross(spin, np.einsum("nij,nj->ni", tensor, spin)))
    return columns


def regressor(chain, gravity, q, velocity, acceleration):
    """(n, 6, 60): joint torques of inverse dynamics, linear in the numbers of the six links."""
    frames = Frames(chain, q)
    n = len(q)
    result = np.zeros((n, 6, 6 * NUMBERS))
    spin, change = np.zeros((n, 3)), np.zeros((n, 3))
    push, before = np.broadcast_to(-gravity, (n, 3)), np.zeros((n, 3))
    moving = [k for k, joint in enumerate(chain) if joint.axis is not None]
    for link, index in enumerate(moving):
        axis, origin, turn = frames.axes[link], frames.origins[link], frames.turns[index]
        lever = origin - before
        push = push + _cross(change, lever) + _cross(spin, _cross(spin, lever))
        change = (change + axis * acceleration[:, link, None]
                  + _cross(spin, axis * velocity[:, link, None]))
        spin = spin + axis * velocity[:, link, None]
        before = origin
        first = slice(NUMBERS * link, NUMBERS * (link + 1))
        force, moment = np.zeros((n, 3, NUMBERS)), np.zeros((n, 3, NUMBERS))
        force[:, :, 0] = push
        for c in range(3):
            arm = turn[:, :, c]
            force[:, :, 1 + c] = _cross(change, arm) + _cross(spin, _cross(spin, arm))
            moment[:, :, 1 + c] = _cross(arm, push)
        moment[:, :, 4:] = _moment_columns(turn, spin, change)
        for joint in range(link + 1):
            reach = origin - frames.origins[joint]
            whole = moment + np.cross(reach[:, :, None], force, axis=1)
            result[:, joint, first] = np.einsum("ni,nic->nc", frames.axes[joint], whole)
    return result
