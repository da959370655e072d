"""SIGHUP with every option changed, one at a time, while flexcompd corrects: what only the start reads is
refused by name; the rest is refused as a whole, and taken as a whole once it is off. Value, rate and
acceleration of every corrected message on the bus are held to the limits that apply.

`test_reconfiguration.py --all` takes every option that may change in turn; else a few.
"""

import random
import re
import signal
import subprocess
import sys
import unittest

from bench_on_a_bus import BIN, BUS, STATES, Flexcompd, decoded, state_of, states
from test_flexcompd import Process

ALL = "--all" in sys.argv
SOME = 3

# What a force sensor needs to be one.
ARM = {"sensor-tcp": "[0,0,0.1]", **{f"sensor-joint-{i + 1}": "[0,0,0.1,0,0,0,0,0,1]" for i in range(6)}}
FIXED = {
    "can": '"vcan7"', "fd": "true", "lcm": '"udpm://239.255.76.67:7667?ttl=0"', "key": '"key"',
    "trigger": '"clock"', "tolerated-losses": "2", "table": '"other.fct"', "state-directory": '"."',
    "period": "0.0156", "priority": "0", "user": '"nobody"', "statistics": '"other.json"',
    "settings-out": '"settings.bin"', "rsi": '"udp://127.0.0.1:49152"', "rsi-mode": '"relative"',
    "rsi-type": '"other"', "rsi-correction": '"Corr"', "rsi-wrench": '"Wrench"', "rsi-arm": '"Arm"',
    "rsi-applied": '"Applied"', "rsi-state": '"State"', "rsi-limit": "0.5", "rsi-step": "0.01",
    "rsi-sign": "[1,1,1,1,1,-1]", "rsi-zero": "[0,0,0,0,0,90]",
    "sensor": '"udp://127.0.0.1:49153"', "sensor-counts": "[1000,1000]", "sensor-zero": "[0,0,1,0,0,0]", "sensor-mass": "5",
    "sensor-center-of-mass": "[0,0,0.1]", "sensor-frame": "[0,0,0.1,0,0,0]", "sensor-gravity": "[0,0,9.81]", **ARM,
}
CHANGEABLE = {
    "heartbeat": 0.05, "model-hash": '"0000000000000000"', "without-identity": "true", "gain": 0.5,
    "filter-cutoff": 5, "correction-limit": 0.0004, "correction-rate": 0.02,
    "correction-acceleration": 1.0, "deflection-limit": 0.0003, "deflection-warning": 0.001,
    "deflection-error": 0.0005, "chart-margin": 0.05, "hold-time": 0.2, "fade-time": 0.05,
    "ready-ticks": 5, "force-range": 3000, "moment-range": 300, "force-rate": 1e5, "moment-rate": 1e4,
    "wrench-stuck-time": 2, "setpoint-age-limit": 0.6, "wrench-age-limit": 0.6, "joint-speed": 1.0,
    "late-ticks": 50,
}
CANNOT_ARM = {"model-hash"}
CANNOT_STAY_ACTIVE = {"deflection-error"}


class Reconfiguration(Process):
    def setUp(self):
        super().setUp()
        self.lines = dict(line.split(" = ", 1) for line in self.job.config.read_text().splitlines()
                          if " = " in line)

    def configure(self, node, **changes):
        """Writes the configuration with some values changed, and sends SIGHUP; what is said to it."""
        self.configure_file(**changes)
        before = len(node.messages())
        node.process.send_signal(signal.SIGHUP)
        received = self.feeder.run(0.3)
        return node.messages()[before:], received

    def configure_file(self, **changes):
        lines = {**self.lines, **{name: str(value) for name, value in changes.items()}}
        self.job.config.write_text("".join(f"{name} = {value}\n" for name, value in lines.items()))

    def turn_off(self):
        self.peer.command("disarm")
        self.assertEqual(STATES["off"], state_of(self.feeder.run(0.8)))

    def limits_of(self, name):
        value = {**self.lines, **{key: str(CHANGEABLE[key]) for key in [name] if key in CHANGEABLE}}
        self.VALUE = float(value.get("correction-limit", 0.01))
        self.RATE = float(value.get("correction-rate", 0.1))
        self.ACCELERATION = float(value.get("correction-acceleration", 5.0))

    def test_this_knows_every_option_and_whether_it_may_change(self):
        text = subprocess.run([str(BIN / "flexcompd"), "--help"], capture_output=True, text=True).stdout
        groups = re.split(r"^Options(.*):$", text, flags=re.MULTILINE)
        named = {title: set(re.findall(r"^  --([a-z0-9-]+)", body, re.MULTILINE))
                 for title, body in zip(groups[1::2], groups[2::2])}
        self.assertEqual(set(FIXED), named[", read at start only"])
        self.assertEqual(set(CHANGEABLE), named[", read again on SIGHUP"])

    def test_what_only_the_start_reads_is_refused_by_name_active_and_off(self):
        # An option on the command line stays, whatever the file says: the interface is in the file.
        self.lines["can"] = f'"{BUS}"'
        self.configure_file()
        in_file = {name: {name: value, "gain": 0.1} for name, value in FIXED.items() if name != "statistics"}
        in_file["sensor"] |= ARM  # it is nothing without
        with Flexcompd(self.job, bus=()) as node:
            received = self.bring_up()
            for name, changes in in_file.items():
                said, more = self.configure(node, **changes)
                self.assertRegex(said, rf"new configuration refused: (.*, )?{name}\b.* cannot change while "
                                       "running; restart flexcompd")
                received += more
            self.assertEqual({STATES["active"]}, set(states(received[-500:])))
            self.assert_limits(received, self.job.period)
            self.turn_off()
            for changes in in_file.values():
                said, _ = self.configure(node, **changes)
                self.assertIn("cannot change while running", said)
            # Nothing of it took effect.
            self.assertEqual(0, self.feeder.arm())
            received = self.feeder.run(1.0)
            self.assert_limits(received, self.job.period)
            self.assertEqual(0, node.stop())

    def test_each_of_the_rest_is_taken_whole_when_off_and_the_limits_hold(self):
        names = sorted(CHANGEABLE)
        if not ALL:
            names = random.Random(28).sample(names, SOME)
        with Flexcompd(self.job) as node:
            for name in names:
                with self.subTest(name):
                    self.one(node, name)
            self.assertEqual(0, node.stop())

    def one(self, node, name):
        self.limits_of("")
        received = self.bring_up()
        said, more = self.configure(node, **{name: CHANGEABLE[name]})
        self.assertIn("new configuration: not ready", said)
        received += more + self.feeder.run(0.5)
        self.assertEqual(STATES["active"], state_of(received))
        self.assert_limits(received, self.job.period)
        self.turn_off()
        self.assertIn("new configuration: ok", self.configure(node, **{name: CHANGEABLE[name]})[0])
        self.limits_of(name)
        self.feeder.forget()
        reply = self.feeder.arm()
        received = self.feeder.run(1.0)
        self.assertEqual(reply != 0, name in CANNOT_ARM)
        if reply == 0 and name not in CANNOT_STAY_ACTIVE:
            self.assertEqual(STATES["active"], state_of(received))
        self.assert_limits(received, self.job.period)
        self.peer.command("disarm")
        self.peer.command("reset")
        self.feeder.run(0.8)
        self.assertIn("new configuration: ok", self.configure(node)[0])
        self.peer.command("reset")


if __name__ == "__main__":
    unittest.main(verbosity=2, argv=[argument for argument in sys.argv if argument != "--all"])
