"""Messages under a key: what somebody on the bus without it can do to flexcompd and the plant."""

import json
import os
import pathlib
import random
import subprocess
import tempfile
import time
import unittest

from bench_on_a_bus import (BIN, BUS, DATABASE, STATES, Flexcompd, HilTest, Job, circularity, decode, decoded,
                            flexcomp, states)
from circle_on_a_bus import LARGEST_SHARE
from test_flexcompd import shared_library

KEY = "3a7f0c9d51e2b8460f1d2c3b4a596877"
PERIOD = 0.01
LOCKSTEP_NODE = ("--trigger", "lockstep")
FORGED_SHIFT = 0.05  # rad
NOT_AVAILABLE = -6.71  # rad, or below: flexcompd has no setpoint
PARTS = {"Setpoint": ("SetpointA", "SetpointB", "SetpointC"), "Command": ("Command",),
         "Corrected": ("CorrectedA", "CorrectedB", "CorrectedC", "UncorrectedA", "UncorrectedB",
                       "UncorrectedC", "Status")}
IDENTIFIER = {message.name: message.frame_id for message in DATABASE.messages}
NAME = {number: name for name, number in IDENTIFIER.items()}


def openssl_cmac(content):
    """Computed by another library than ours."""
    done = subprocess.run(["openssl", "mac", "-cipher", "AES-128-CBC", "-macopt", f"hexkey:{KEY}", "CMAC"],
                          input=content, capture_output=True, check=True)
    return bytes.fromhex(done.stdout.decode())


def expected_mac(name, frames, freshness):
    """As flexcomp.dbc says."""
    content = IDENTIFIER[f"{name}Authentication"].to_bytes(2, "little")
    content += b"".join(bytes(frame.data) for frame in frames) + freshness.to_bytes(8, "little")
    return int.from_bytes(openssl_cmac(content)[:4], "little")


def freshness_now():
    return time.time_ns() // 10_000


def authenticate(client, name, frames, freshness, mac=None):
    """The frames and their authentication: the right one, unless another is given."""
    mac = expected_mac(name, frames, freshness) if mac is None else mac
    counter = decode(frames[0])[1]["counter"]
    return [*frames, client.encode(f"{name}Authentication", counter, freshness=freshness & 0xFFFFF, mac=mac)]


class Sets:
    """Whole messages among frames that come one by one, with their authentication."""

    def __init__(self, name):
        self.names = (*PARTS[name], f"{name}Authentication")
        self.frames = []

    def take(self, frame):
        """The message that this frame completes."""
        name = NAME.get(frame.arbitration_id)
        if name == self.names[0]:
            self.frames = []
        if len(self.frames) < len(self.names) and name == self.names[len(self.frames)]:
            self.frames.append(frame)
            if len(self.frames) == len(self.names):
                return self.frames
        return None


class Attacker:
    """Knows flexcomp.dbc and all that it has heard, but no key."""

    def __init__(self, client):
        self.client = client
        self.random = random.Random(1)
        self.setpoints = Sets("Setpoint")
        self.commands = Sets("Command")
        self.answers = Sets("Corrected")
        self.recorded = None
        self.answer = None
        self.command = None
        self.heard = []

    def listen(self, seconds):
        for frame in self.client.receive(seconds):
            self.heard.append(frame)
            self.recorded = self.setpoints.take(frame) or self.recorded
            self.command = self.commands.take(frame) or self.command
            self.answer = self.answers.take(frame) or self.answer

    def hear_out(self):
        """All that waits to be read: on a busy machine an attacker lags behind the bus by most of a run."""
        before = -1
        while before < len(self.heard):
            before = len(self.heard)
            self.listen(0.3)

    def forged(self, heard):
        """A message that was heard, with its angles shifted, as the next in sequence: its checksums fit."""
        frames = []
        for frame in heard:
            name, signals = decode(frame)
            counter = (signals.pop("counter") + 1) % 16
            shifted = {key: value + FORGED_SHIFT if key.startswith("q") else value
                       for key, value in signals.items() if key != "crc"}
            frames.append(self.client.encode(name, counter, **shifted))
        return frames

    def attack(self):
        if self.recorded is None:
            return
        setpoint = self.forged(self.recorded[:3])
        disarm = self.client.frames("Command", command=2)
        answer = self.forged(self.answer[:7]) if self.answer else []
        mac = self.random.getrandbits(32)
        now = freshness_now()
        for frames in (setpoint, authenticate(self.client, "Setpoint", setpoint, now, mac), disarm, answer,
                       authenticate(self.client, "Command", disarm, now, mac), self.recorded, self.answer or []):
            for frame in frames:
                self.client.put(frame)

    def uncorrected(self):
        """Joint 1 of the setpoints that flexcompd says it corrected."""
        angles = [decode(frame)[1]["q1"] for frame in self.heard
                  if NAME.get(frame.arbitration_id) == "UncorrectedA"]
        return [angle for angle in angles if angle > NOT_AVAILABLE]

    def true_setpoints(self):
        """Joint 1 of those under the key."""
        sets = Sets("Setpoint")
        return {decode(whole[0])[1]["q1"] for frame in self.heard if (whole := sets.take(frame))}


class Authentication(HilTest):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        cls.job = Job(folder, "kr270", 0.03, period=PERIOD, radius=0.03)
        cls.job.be_patient()
        cls.key = folder / "key"
        cls.key.touch(0o600)
        cls.key.write_text(KEY + "\n")
        flexcomp("table", "sign", cls.job.table, "--key", cls.key, "--counter", 1)

    def plant(self, *options, bus=f"can:{BUS}"):
        command = [BIN / "flexcomp", "plant", "--model", self.job.model, "--path", self.job.path, "--period", PERIOD,
                   "--bus", bus, "--json", "--out", self.folder / "run.csv"]
        return subprocess.Popen(list(map(str, [*command, *options])), stdout=subprocess.PIPE, text=True)

    def started(self, *options, **more):
        """flexcompd, past the time for which it takes nothing."""
        node = Flexcompd(self.job, *options, **more)
        time.sleep(0.4)
        return node

    def play(self, plant, attacker, pause):
        """Attacks until the plant has ended; what it says."""
        while plant.poll() is None:
            attacker.listen(pause)
            attacker.attack()
        return json.loads(plant.stdout.read())

    def circularity_inside(self, *options):
        """With the compensator in the plant's own process: no bus, no key, nobody else. In lock-step a run on
        the bus is the same, however much time the attacker takes."""
        out = self.folder / "inside.csv"
        flexcomp("plant", "--model", self.job.model, "--path", self.job.path, "--table", self.job.table,
                 "--period", PERIOD, "--out", out, *options)
        return circularity(out)

    def test_forged_and_replayed_messages_do_not_change_the_correction(self):
        undisturbed = self.circularity_inside()
        without = self.circularity_inside("--without-compensation")
        attacker = Attacker(self.client())
        library = shared_library(self.folder, "abort_on_allocation")
        with self.started("--key", self.key, *LOCKSTEP_NODE, preload=library) as node, \
                self.plant("--key", self.key, "--lockstep") as plant:
            summary = self.play(plant, attacker, 0.02)
            self.assertEqual(0, node.stop(), node.messages())
            statistics = node.statistics()
        self.assertTrue(summary["armed"], summary)
        attacked = circularity(self.folder / "run.csv")
        refused = {name: statistics[name] for name in statistics if name.endswith("_messages")}
        print(f"{1e3 * attacked:.4f} mm under attack, {1e3 * undisturbed:.4f} mm without an attacker, "
              f"{1e3 * without:.4f} mm uncorrected; {refused}")
        # A frame that comes between those of a message spoils it, as noise would: some may be lost.
        self.assertLessEqual(attacked, LARGEST_SHARE * without)
        self.assertLess(statistics["setpoint"]["lost"], 0.02 * statistics["setpoint"]["received"])
        self.assertEqual(0, summary["node_status"] & 0x0FFF)
        for name in ("forged_messages", "not_fresh_messages", "unauthenticated_messages"):
            self.assertGreater(statistics[name], 50, name)
        self.assertEqual(0, statistics["setpoint"]["contradicting"])
        attacker.hear_out()
        uncorrected = attacker.uncorrected()
        self.assertGreater(len(uncorrected), 50)
        self.assertLessEqual(set(uncorrected), attacker.true_setpoints())

    def test_over_can_fd_it_corrects_under_the_key_as_without(self):
        with self.started("--key", self.key, "--fd", *LOCKSTEP_NODE) as node, \
                self.plant("--key", self.key, "--lockstep", bus=f"canfd:{BUS}") as plant:
            self.assertEqual(0, plant.wait())
            node.stop()
        self.assertAlmostEqual(self.circularity_inside(), circularity(self.folder / "run.csv"), delta=1e-6)

    def test_the_same_attack_succeeds_where_there_is_no_key(self):
        attacker = Attacker(self.client())
        with Flexcompd(self.job) as node, self.plant() as plant:
            attacker.setpoints.names = PARTS["Setpoint"]
            while attacker.recorded is None:
                attacker.listen(0.1)
            for _ in range(25):
                attacker.listen(0.023)
                attacker.attack()
            plant.terminate()
            node.stop()
        attacker.hear_out()
        corrected = attacker.uncorrected()
        forged = max(corrected) - min(corrected)
        self.assertTrue(forged > 0.9 * FORGED_SHIFT or STATES["latched"] in states(attacker.heard))

    def test_what_was_recorded_is_refused_after_a_restart(self):
        attacker = Attacker(self.client())
        with self.started("--key", self.key) as node:
            with self.plant("--key", self.key) as plant:
                while attacker.command is None:
                    attacker.listen(0.1)
                plant.terminate()
            attacker.listen(0.1)
            self.assertIn("CommandReply", {name for name, _ in decoded(attacker.heard)})
            node.process.kill()
        attacker.hear_out()
        attacker.heard = []
        with Flexcompd(self.job, "--key", self.key, wait=False) as node:
            replays_left = 50
            while replays_left > 0:
                replays_left -= node.ticks()
                for frame in (*attacker.command, *attacker.recorded):
                    attacker.client.put(frame)
                attacker.listen(0.02)
            self.assertNotIn("CommandReply", {name for name, _ in decoded(attacker.heard)})
            self.assertGreater(len(attacker.heard), 50)
            self.assertEqual([], attacker.uncorrected())
            self.assertEqual("the sender has not said which robot it works with\n",
                             flexcomp("node", "arm", "--bus", f"can:{BUS}", "--key", self.key, code=1))
            node.stop()
            self.assertGreater(node.statistics()["forged_messages"] + node.statistics()["not_fresh_messages"], 10)

    def test_a_client_made_from_the_dbc_and_another_library_is_understood_both_ways(self):
        client = self.client()
        with self.started("--key", self.key) as node:
            listener = Attacker(client)
            for _ in range(5):  # a busy machine may take too long to start openssl
                freshness = freshness_now() + 20_000  # ahead of the clock, as is allowed
                for frame in authenticate(client, "Command", client.frames("Command", command=4), freshness):
                    client.put(frame)
                listener.listen(0.4)
                if any(frame.arbitration_id == IDENTIFIER["CommandReply"] for frame in listener.heard):
                    break
            listener.listen(1.0)  # one statistic after the other
            node.stop()
        signals = decoded(listener.heard)
        self.assertIn(4, [reply["command"] for name, reply in signals if name == "CommandReply"])
        self.assertLessEqual({9, 10, 11}, {value["name"] for name, value in signals if name == "Statistic"})
        corrected = Sets("Corrected")
        whole = [frames for frame in listener.heard if (frames := corrected.take(frame))]
        now = freshness_now()
        last = decode(whole[-1][-1])[1]
        freshness = now - ((now - last["freshness"]) & 0xFFFFF)
        self.assertEqual(expected_mac("Corrected", whole[-1][:-1], freshness), last["mac"])

    def test_a_command_without_the_key_is_not_answered(self):
        with Flexcompd(self.job, "--key", self.key) as node:
            done = subprocess.run([str(BIN / "flexcomp"), "node", "arm", "--bus", f"can:{BUS}"],
                                  capture_output=True, text=True)
            self.assertEqual(2, done.returncode)
            self.assertIn("nobody answers", done.stderr)
            node.stop()

    def test_a_table_comes_over_the_bus_under_the_key(self):
        with self.started("--key", self.key) as node:
            bus = ("--bus", f"can:{BUS}")
            self.assertEqual("ok\n", flexcomp("node", "send-table", self.job.table, *bus, "--key", self.key))
            node.stop()

    def test_unusable_keys_get_one_line(self):
        readable = self.folder / "readable"
        readable.write_text(KEY)
        readable.chmod(0o644)
        short = self.folder / "short"
        short.touch(0o600)
        short.write_text(KEY[1:])
        for program in (["flexcompd", "--model-hash", "0092596dd2483751", "--can", BUS],
                        ["flexcomp", "node", "arm", "--bus", f"can:{BUS}"]):
            for key, complaint in ((readable, "chmod 600"), (short, "32 hexadecimal digits"),
                                   ("/no/such/key", "No such file")):
                self.refuse([BIN / program[0], *program[1:], "--key", key], complaint)
        lcm = "udpm://239.255.76.67:7667?ttl=0"
        self.refuse([BIN / "flexcompd", "--model-hash", "0092596dd2483751", "--can", BUS, "--lcm", lcm, "--key",
                     self.key], "CAN only")
        self.refuse([BIN / "flexcomp", "node", "arm", "--bus", f"lcm:{lcm}", "--key", self.key], "CAN only")

    def refuse(self, command, saying):
        done = subprocess.run(list(map(str, command)), capture_output=True, text=True, timeout=10)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertEqual(1, done.stderr.count("\n"), done.stderr)
        self.assertIn(saying, done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
