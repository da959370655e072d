"""flexcompd --sensor and a force sensor at the flange, over UDP on the loopback, beside setpoints over CAN or RSI."""

import math
import unittest
import xml.etree.ElementTree as ET

from bench_on_a_bus import (ROBOTS, STATES, Feeder, Flexcompd, HilTest, Job, corrections, decode, decoded, flexcomp,
                            states)
from rsi_bench import AXES, FORCES, ROUNDING, Controller, free_port
from sensor_bench import STOP, STREAM, Arm, MountedSensor
from test_flexcompd import shared_library

FRAME = [0.01, -0.02, 0.05, 0.1, -0.2, 0.5]  # of the sensor in the flange: askew
TCP, MASS, CENTER, GRAVITY = [0.02, 0.01, 0.31], 14.0, [0.01, 0.0, 0.16], [0.0, 0.0, -9.81]
SIGNAL = 4e-7  # rad, steps of the classic frames
ROBOT = ROBOTS / "kr270"


class SensorTest(HilTest):
    """In lock-step: each setpoint makes one tick, whatever the machine is busy with."""

    def setUp(self):
        super().setUp()
        self.job = Job(self.folder, period=0.004, model=self.robot_with_a_tool())
        self.sensor = MountedSensor(Arm(ROBOT / "kr270.urdf", "base_link", "tool0"), FRAME, TCP, MASS, CENTER, GRAVITY)
        self.addCleanup(self.sensor.close)
        flexcomp("configure", "--model", self.job.model, "--table", self.job.table, "--out", self.job.config,
                 "--sensor", f"127.0.0.1:{self.sensor.port}", "--sensor-frame", ",".join(map(str, FRAME)))
        self.peer = self.client()
        self.feeder = Feeder(self.job, self.peer)

    def robot_with_a_tool(self):
        model = self.folder / "robot.yaml"
        text = (ROBOT / "robot.yaml").read_text()
        text = text.replace("urdf: ", f"urdf: {ROBOT}/").replace("gravity: [0, 0, 0]", f"gravity: {GRAVITY}")
        model.write_text(text + f"tool: {{xyz: {TCP}, mass: {MASS}, com: {CENTER}}}\n")
        return model

    def unplug(self):
        """The next node has no sensor."""
        lines = self.job.config.read_text().splitlines(keepends=True)
        self.job.config.write_text("".join(line for line in lines if "sensor" not in line))

    def node(self, *options, **arguments):
        node = Flexcompd(self.job, "--trigger", "lockstep", "--priority", "0", *options, **arguments)
        self.addCleanup(node.__exit__)
        return node

    def exchange(self, place, press):
        """One setpoint of the circle with its wrench, which `press` brings to the node; what comes back."""
        q, wrench = self.feeder.q[place % len(self.feeder.q)], self.feeder.wrench[place % len(self.feeder.q)]
        if place % 10 == 0:
            self.peer.send_identity(self.job.model_hash)
        press(q, wrench)
        self.peer.send_setpoint(q)
        received = []
        while not received or decode(received[-1])[0] != "Status":
            frame = self.peer.bus.recv(10)
            self.assertIsNotNone(frame, "no answer within 10 s")
            received.append(frame)
        return received

    def follow(self, places, press):
        received = []
        for place in places:
            received += self.exchange(place, press)
        return received

    def arm_and_follow(self, press):
        self.follow(range(60), press)
        self.peer.command("arm")
        return self.follow(range(60, 400), press)

    def feel(self, q, wrench):
        """Three records a period, of which the last is the newest."""
        load = self.sensor.load(q, wrench)
        for share in (0.2, 0.9, 1):
            self.sensor.send([share * x for x in load])


class Can(SensorTest):
    def test_the_correction_is_that_of_the_same_wrench_over_can(self):
        node = self.node(preload=shared_library(self.folder, "abort_on_allocation"))  # a tick never takes from the heap
        by_sensor = self.arm_and_follow(self.feel)
        self.assertEqual(0, node.stop(), node.messages())
        statistics = node.statistics()["wrench"]
        self.unplug()
        self.node()
        by_can = self.arm_and_follow(lambda q, wrench: self.peer.send_wrench(wrench))

        self.assertEqual(STATES["active"], states(by_can)[-1])
        self.assertEqual(states(by_can), states(by_sensor))
        ours, others = corrections(by_sensor), corrections(by_can)
        self.assertEqual(len(others), len(ours))
        self.assertGreater(max(abs(x) for each in others for x in each), 1000 * SIGNAL)
        self.assertLess(max(abs(a - b) for x, y in zip(ours, others) for a, b in zip(x, y)), 4 * SIGNAL)
        self.assertGreater(statistics["received"], 3 * 390)
        self.assertEqual([STREAM], self.sensor.requests[:1])

    def test_a_sensor_that_is_silent_or_faulty_ends_the_correction_and_is_asked_again(self):
        node = self.node()
        for name, press in (("silent", lambda *_: self.sensor.listen()),
                            ("faulty", lambda q, wrench: self.sensor.send(self.sensor.load(q, wrench), 1 << 31))):
            with self.subTest(name):
                self.assertEqual(STATES["active"], states(self.arm_and_follow(self.feel))[-1])
                asked = len(self.sensor.requests)
                self.assertEqual(STATES["latched"], states(self.follow(range(400, 1000), press))[-1])
                self.assertGreaterEqual(len(self.sensor.requests), asked + 3)
                self.sensor.restart()
                self.follow(range(1000, 1200), self.feel)
                self.peer.command("reset")
                self.follow(range(1200, 1210), self.feel)
        self.assertEqual(0, node.stop())
        self.sensor.listen(5)
        self.assertEqual(STOP, self.sensor.requests[-1])

    def test_a_wrench_over_can_beside_it_is_a_second_sender(self):
        self.node()
        self.arm_and_follow(self.feel)

        def both(q, wrench):
            self.feel(q, wrench)
            self.peer.send_wrench(wrench)

        received = self.follow(range(400, 1000), both)
        self.assertEqual(STATES["latched"], states(received)[-1])
        codes = [signals for name, signals in decoded(received) if name == "Status"]
        self.assertTrue(codes[-1]["node_status"])


class Rsi(SensorTest):
    def drive(self, *options, press):
        """Corrections of every cycle, one answer a telegram."""
        port = free_port()
        node = self.node("--rsi-arm", "Arm", "--rsi-applied", "AxisCorrMon", "--rsi-state", "State",
                         "--without-identity", *options, bus=("--rsi", f"udp://127.0.0.1:{port}"))
        controller = Controller(self.job, port)
        self.addCleanup(controller.close)
        corrections_made = []
        for place in range(600):
            controller.armed = place > 100
            datagram = controller.next_telegram()
            press(datagram)
            controller.put(datagram)
            self.assertTrue(controller.take(controller.receive(10)))
            corrections_made.append(controller.applied)
        self.assertEqual(STATES["active"], controller.state)
        self.assertEqual(0, node.stop())
        return corrections_made

    def feel_as_told(self, datagram):
        """What the telegram says of angles and wrench, as the sensor feels it."""
        root = ET.fromstring(datagram)
        q = [math.radians(float(root.find("ASPos").get(axis))) for axis in AXES]
        self.feel(q, [float(root.find("FT").get(name)) for name in FORCES])

    def test_corrections_are_those_of_the_same_wrench_in_the_telegram(self):
        by_sensor = self.drive(press=self.feel_as_told)
        self.unplug()
        by_telegram = self.drive("--rsi-wrench", "FT", press=lambda datagram: None)
        self.assertGreater(max(map(abs, by_telegram[-1])), 0.01)
        self.assertLess(max(abs(a - b) for x, y in zip(by_sensor, by_telegram) for a, b in zip(x, y)), 4 * ROUNDING)


if __name__ == "__main__":
    unittest.main()
