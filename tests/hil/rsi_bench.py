"""A robot controller with RSI for the tests, which knows nothing of flexcomp but what a controller knows: XML over
UDP, by Python's own parser."""

import csv
import math
import socket
import time
import xml.etree.ElementTree as ET

AXES = [f"A{i}" for i in range(1, 7)]
FORCES = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
LARGEST, LARGEST_STEP = 1.0, 0.05  # degrees, limits that flexcompd has by itself
ROUNDING = 2e-6  # degrees
OPTIONS = ["--rsi-wrench", "FT", "--rsi-arm", "Arm", "--rsi-applied", "AxisCorrMon", "--rsi-state", "State",
           "--without-identity", "--priority", "0"]


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def telegram(ipoc, setpoint, wrench, applied, armed, late):
    root = ET.Element("Rob", {"Type": "KUKA"})
    for name, names, values in (("RIst", list("XYZABC"), [0.0] * 6), ("AIPos", AXES, setpoint),
                                ("ASPos", AXES, setpoint), ("AxisCorrMon", AXES, applied), ("FT", FORCES, wrench)):
        ET.SubElement(root, name, {key: f"{value:.4f}" for key, value in zip(names, values)})
    ET.SubElement(root, "Delay", {"D": str(late)})
    ET.SubElement(root, "Arm").text = str(int(armed))
    ET.SubElement(root, "IPOC").text = str(ipoc)
    return ET.tostring(root)


class Controller:
    """Sends telegrams along a path and moves by the answers; each is held to the limits."""

    def __init__(self, job, port):
        rows = list(csv.DictReader(job.path.open()))
        self.path = [[math.degrees(float(row[f"q_cmd_{i}"])) for i in range(1, 7)] for row in rows]
        self.wrench = [[float(row[name]) for name in map(str.lower, FORCES)] for row in rows]
        self.port = port
        self.period = job.period
        self.place = 0
        self.ipoc = 4208163634
        self.late = 0
        self.armed = False
        self.applied = [0.0] * 6
        self.state = None
        self.socket = None
        self.start()

    def start(self):
        """RSI starts: from a port of its own, with a correction of zero."""
        self.close()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.connect(("127.0.0.1", self.port))
        self.applied = [0.0] * 6
        self.late = 0
        self.armed = False

    def close(self):
        if self.socket is not None:
            self.socket.close()

    def next_telegram(self):
        self.place += 1
        self.ipoc += round(1000 * self.period)
        row = self.place // 4 % len(self.path)
        after = (row + 1) % len(self.path)
        share = self.place % 4 / 4
        setpoint = [a + share * (b - a) for a, b in zip(self.path[row], self.path[after])]
        force = [value + 2 * math.sin(self.place) for value in self.wrench[row][:3]] + self.wrench[row][3:]
        return telegram(self.ipoc, setpoint, force, self.applied, self.armed, self.late)

    def put(self, datagram):
        try:
            self.socket.send(datagram)
        except ConnectionRefusedError:  # nobody listened to the last one
            pass

    def receive(self, patience):
        """The next datagram, or None."""
        self.socket.settimeout(max(patience, 1e-4))
        try:
            return self.socket.recv(2048)
        except (socket.timeout, ConnectionRefusedError):
            return None

    def take(self, answer):
        """The correction in it; true if it has this cycle's IPOC."""
        root = ET.fromstring(answer)
        assert root.tag == "Sen" and root.get("Type") == "ImFree", answer
        if int(root.find("IPOC").text) != self.ipoc:
            return False
        new = [float(root.find("AK").get(axis)) for axis in AXES]
        for before, after in zip(self.applied, new):
            assert abs(after) <= LARGEST + ROUNDING, answer
            assert abs(after - before) <= LARGEST_STEP + ROUNDING, (self.applied, answer)
        self.applied = new
        self.state = int(root.find("State").text)
        return True

    def cycle(self, datagram=None):
        """One cycle; true if it was answered in time."""
        end = time.monotonic() + self.period
        self.put(self.next_telegram() if datagram is None else datagram)
        answered = False
        while (left := end - time.monotonic()) > 0:
            answer = self.receive(left)
            answered = (answer is not None and self.take(answer)) or answered
        self.late += not answered
        return answered

    def run(self, seconds):
        """How many cycles were answered."""
        return sum(self.cycle() for _ in range(round(seconds / self.period)))

    def run_until(self, condition, seconds=20):
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, f"state {self.state}, correction {self.applied}"
            self.cycle()

    def largest(self):
        return max(map(abs, self.applied))
