"""A force sensor of ATI for the tests, and an arm from its URDF. Both know nothing of flexcomp: the sensor speaks what
ATI's manual of the Net F/T says (chapter 10), by Python's own packing of bytes; the arm is read by Python's own parser."""

import math
import socket
import struct
import xml.etree.ElementTree as ET

COUNTS = (1_000_000, 1_000_000)  # for a newton, for a newton metre
STOP, STREAM = 0, 2


def product(a, b):
    return [[sum(x * y for x, y in zip(row, column)) for column in zip(*b)] for row in a]


def applied(a, v):
    return [sum(x * y for x, y in zip(row, v)) for row in a]


def transposed(a):
    return [list(column) for column in zip(*a)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(a, b, sign=1):
    return [x + sign * y for x, y in zip(a, b)]


def turn(axis, angle):
    """Rotation about a unit axis."""
    c, s, (x, y, z) = math.cos(angle), math.sin(angle), axis
    return [[c + x * x * (1 - c), x * y * (1 - c) - z * s, x * z * (1 - c) + y * s],
            [y * x * (1 - c) + z * s, c + y * y * (1 - c), y * z * (1 - c) - x * s],
            [z * x * (1 - c) - y * s, z * y * (1 - c) + x * s, c + z * z * (1 - c)]]


def rotation(rpy):
    r, p, y = rpy
    return product(product(turn([0, 0, 1], y), turn([0, 1, 0], p)), turn([1, 0, 0], r))


class Arm:
    """Joints of a URDF from one link to another."""

    def __init__(self, urdf, base, tip):
        by_child = {joint.find("child").get("link"): joint for joint in ET.parse(urdf).getroot().iter("joint")}
        self.joints = []
        while tip != base:
            self.joints.insert(0, by_child[tip])
            tip = by_child[tip].find("parent").get("link")

    def pose(self, q):
        """Rotation and position of the last link in the first."""
        angles = iter(q)
        r, p = rotation([0, 0, 0]), [0.0, 0.0, 0.0]
        for joint in self.joints:
            origin = joint.find("origin")
            p = plus(p, applied(r, [float(x) for x in origin.get("xyz").split()]))
            r = product(r, rotation([float(x) for x in origin.get("rpy").split()]))
            if joint.get("type") == "revolute":
                r = product(r, turn([float(x) for x in joint.find("axis").get("xyz").split()], next(angles)))
        return r, p


class ForceSensor:
    """Listens for a request, and sends records to whoever made it."""

    def __init__(self):
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.requests = []
        self.peer = None
        self.restart()

    def restart(self):
        """Power was off: it streams to nobody, and counts from one again."""
        self.sequence = 0
        self.peer = None

    def close(self):
        self.socket.close()

    def listen(self, seconds=0.0):
        """Takes the requests that have come, or the first that comes in this time."""
        self.socket.settimeout(seconds or 1e-6)
        try:
            while True:
                datagram, peer = self.socket.recvfrom(64)
                header, command, count = struct.unpack("!HHI", datagram)
                assert (header, count) == (0x1234, 0), datagram
                self.requests.append(command)
                self.peer = peer if command == STREAM else None
                self.socket.settimeout(1e-6)
        except TimeoutError:
            pass

    def send(self, load, status=0):
        """A record of forces (N) and moments (N m) in its own frame, if anybody has asked for them."""
        self.listen()
        self.sequence += 1
        if self.peer is not None:
            counts = [round(COUNTS[i // 3] * x) for i, x in enumerate(load)]
            self.socket.sendto(struct.pack("!III6i", self.sequence, 7 * self.sequence, status, *counts), self.peer)


class MountedSensor(ForceSensor):
    """Between the flange of an arm and a tool."""

    def __init__(self, arm, frame, tcp, mass, center_of_mass, gravity):
        super().__init__()
        self.arm, self.tcp, self.mass, self.center_of_mass, self.gravity = arm, tcp, mass, center_of_mass, gravity
        self.place, self.turned = frame[:3], rotation(frame[3:])

    def load(self, q, wrench):
        """What it feels of a wrench on the tool at the TCP (base frame), and of the tool's weight."""
        r, p = self.arm.pose(q)
        sensor = plus(p, applied(r, self.place))
        tcp = plus(p, applied(r, self.tcp))
        center = plus(p, applied(r, self.center_of_mass))
        weight = [self.mass * g for g in self.gravity]
        force = plus(wrench[:3], weight)
        moment = plus(plus(wrench[3:], cross(plus(tcp, sensor, -1), wrench[:3])),
                      cross(plus(center, sensor, -1), weight))
        back = transposed(product(r, self.turned))
        return applied(back, force) + applied(back, moment)
