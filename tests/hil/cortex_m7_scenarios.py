"""Scenarios of flexcompd, played against the firmware on an emulated board. Runs in the guest that has the
board's serial line; asks `test_cortex_m7` outside for what happens to the board."""

import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

from bench_on_a_bus import (BIN, BUS, STATES, Feeder, HilTest, Job, corrections, decoded, flexcomp, of_names,
                            other_table, state_of, states, table_frames, transfer)
from circle_on_a_bus import LARGEST_SHARE, mill

HERE = pathlib.Path(__file__).parent
OUTSIDE = pathlib.Path(os.environ["FLEXCOMP_BOARD"])
IN_FIXED_MEMORY = 3
NOT_SIGNED, FORGED = 40, 41
STACK_USED = 8  # a statistic
LONGEST = 30  # s, to wait for what comes at once where the machine is idle
COARSE = 1e-5  # m, tolerance of a table that is half as long on its way


def ask(order, **values):
    """Has something done to the board."""
    request = OUTSIDE / "request"
    aside = OUTSIDE / "request.new"
    aside.write_text(json.dumps({"order": order} | {name: str(value) for name, value in values.items()}))
    aside.rename(request)
    wait_until(lambda: not request.exists(), f"nobody did '{order}'")


def wait_until(done, complaint, longest=LONGEST):
    end = time.monotonic() + longest
    while not done():
        if time.monotonic() > end:
            raise AssertionError(complaint)
        time.sleep(0.02)


def set_interface(*state):
    return subprocess.run(["ip", "link", "set", BUS, *state], stderr=subprocess.DEVNULL).returncode == 0


def setUpModule():
    global interface
    interface = subprocess.Popen([sys.executable, HERE / "serial_can.py"])
    wait_until(lambda: set_interface("up", "txqueuelen", "1000"), f"there is no {BUS}")


def tearDownModule():
    interface.kill()


class Firmware(HilTest):
    def start(self, job, *options):
        settings = self.folder / "settings.bin"
        subprocess.run([BIN / "flexcompd", "--config", job.config, *options, "--settings-out", settings],
                       check=True)
        set_interface("down")  # what waits to be sent since the test before goes
        set_interface("up")
        ask("start", settings=settings, table=job.table)


class InLockstep(Firmware):
    def test_it_keeps_the_circle_as_round_as_flexcompd_does(self):
        job = Job(self.folder, "kr270", 0.1, radius=0.05)
        self.start(job, "--trigger", "lockstep")
        before, _ = mill(job, self.folder / "without.csv", "--table", job.table, "--without-compensation")
        after, _ = mill(job, self.folder / "with.csv", "--bus", f"can:{BUS}", "--lockstep")
        print(f"{1e3 * before:.4f} mm without, {1e3 * after:.4f} mm with, {100 * after / before:.1f} %")
        self.assertLessEqual(after / before, LARGEST_SHARE)


class AtThePaceOfTheClock(Firmware):
    """Periods of 40 ms: the line goes through a guest and back, on a machine that may be busy. All tests have one
    job, which takes a guest two seconds to make."""

    PERIOD = 0.04
    ATTEMPTS = 5  # to bring it up; on a busy machine one may come while the board misses a setpoint
    STALE = 2  # s without a setpoint; guest and board have clocks of their own, and a busy machine runs one at a time

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.job = Job(scratch.name, period=cls.PERIOD)
        cls.job.be_patient(cls.STALE)


class Fed(AtThePaceOfTheClock):
    def setUp(self):
        super().setUp()
        self.start(self.job)
        self.peer = self.client()
        self.feeder = Feeder(self.job, self.peer)

    def bring_up(self):
        """What it said meanwhile."""
        for _ in range(self.ATTEMPTS):
            self.feeder.forget()
            self.feeder.run(2.2)  # the robot is named every two seconds
            self.peer.command("arm")
            received = self.feeder.run(1.0)
            received += self.feeder.run_until(lambda since: state_of(since) == STATES["active"])
            if states(received)[-1:] == [STATES["active"]]:
                break
            self.peer.command("reset")
        told = decoded(received)
        self.assertEqual([0], [signals["reply"] for name, signals in told if name == "CommandReply"])
        self.assertEqual(STATES["active"], states(received)[-1], f"{told[-20:]}")
        return received


class InRealTime(Fed):
    def test_it_speaks_as_flexcompd_does_with_its_table_in_flash(self):
        received = self.bring_up()
        self.peer.command("report")
        received += self.feeder.run_until(
            lambda since: STACK_USED in [signals["name"] for _, signals in of_names(since, "Statistic")],
            longest=LONGEST)
        names = {name for name, _ in decoded(received)}
        self.assertLessEqual({"CorrectedA", "UncorrectedC", "Status", "Latched", "Heartbeat", "TableLow",
                              "TableHigh", "Statistic", "CommandReply"}, names)
        beats = [signals["slot"] for name, signals in decoded(received) if name == "Heartbeat"]
        self.assertEqual({IN_FIXED_MEMORY}, set(beats))
        self.assert_limits(received, self.PERIOD)
        stack = [signals["value"] for name, signals in decoded(received)
                 if name == "Statistic" and signals["name"] == STACK_USED]
        print(f"stack: {stack[0]} bytes at most")
        self.assertGreater(stack[0], 500)
        self.assertLessEqual(stack[0], 4096)

    def test_a_table_over_the_bus_is_swapped_in_while_correcting(self):
        frames = table_frames(self.peer, other_table(self.job, COARSE))
        self.bring_up()
        received, replies = transfer(self.feeder, frames)
        self.assertEqual([0, 0], [reply["result"] for reply in replies])
        self.assert_limits(received, self.PERIOD)
        self.assertEqual(STATES["active"], states(received)[-1])
        beats = [signals["slot"] for name, signals in decoded(received) if name == "Heartbeat"]
        self.assertEqual(1, beats[-1])

    def test_a_damaged_table_is_refused_and_the_one_in_use_stays(self):
        data = bytearray(other_table(self.job, COARSE))
        data[500] ^= 1
        frames = table_frames(self.peer, bytes(data))
        self.bring_up()
        received, replies = transfer(self.feeder, frames)
        self.assertEqual(12, replies[-1]["result"])
        self.assertEqual(STATES["active"], states(received)[-1])

    def run_until_it_is(self, state):
        """Until what was on its way has come, however busy the machine."""
        self.feeder.forget()
        self.feeder.run_until(lambda since: state_of(since) == STATES[state], longest=LONGEST)

    def assert_latched_until_reset_and_armed(self):
        self.run_until_it_is("latched")
        received = self.feeder.run(1.0)
        self.assertEqual({STATES["latched"]}, set(states(received)))
        self.assert_zero(received)
        self.peer.command("reset")
        self.bring_up()

    def test_a_line_that_is_cut_makes_it_fade_out(self):
        self.bring_up()
        ask("cut")
        self.feeder.run(self.STALE + 1)  # what was on its way, and until it has faded out
        self.assertEqual([], corrections(self.feeder.run(1.0)))
        ask("mend")
        self.assert_latched_until_reset_and_armed()

    def test_text_that_is_spoilt_makes_it_fade_out(self):
        self.bring_up()
        ask("corrupt")
        self.feeder.run(self.STALE + 1)
        ask("mend")
        self.assert_latched_until_reset_and_armed()

    def test_a_line_that_is_not_read_for_a_second_lives_on(self):
        self.bring_up()
        interface.send_signal(signal.SIGSTOP)
        time.sleep(1)
        interface.send_signal(signal.SIGCONT)
        self.feeder.run(1.0)  # what was held up
        lives = self.feeder.run_until(lambda since: len(states(since)) > 0.5 / self.PERIOD, longest=LONGEST)
        self.assertGreater(len(states(lives)), 0.5 / self.PERIOD)

    def test_a_reset_of_the_processor_leaves_it_off_until_it_is_armed(self):
        self.bring_up()
        ask("reset")
        self.run_until_it_is("off")
        received = self.feeder.run(1.0)
        self.assertEqual({STATES["off"]}, set(states(received)))
        self.assertEqual({0.0}, {round(value, 9) for row in corrections(received) for value in row})
        self.bring_up()


class WithAKey(Fed):
    """Only tables signed with the key in its settings are taken."""

    KEY = "3a7f0c9d51e2b8460f1d2c3b4a596877"

    def start(self, job, *options):
        self.key = self.folder / "key"
        self.key.touch(0o600)
        self.key.write_text(self.KEY + "\n")
        other_table(job, COARSE)
        self.sign(job.table, 5)
        super().start(job, "--key", self.key, *options)
        self.assertEqual(0o600, (self.folder / "settings.bin").stat().st_mode & 0o777)

    def sign(self, table, version):
        flexcomp("table", "sign", table, "--key", self.key, "--counter", version)

    def answer(self, table):
        _, replies = transfer(self.feeder, table_frames(self.peer, table))
        return replies[-1]["result"]

    def test_a_table_over_the_bus_must_be_signed(self):
        other = self.job.folder / "other.fct"
        unsigned = other.read_bytes()
        self.sign(other, 6)
        self.bring_up()
        self.assertEqual(NOT_SIGNED, self.answer(unsigned))
        forged = bytearray(other.read_bytes())
        forged[-20] = 9  # its version
        self.assertEqual(FORGED, self.answer(bytes(forged)))
        self.assertEqual(0, self.answer(other.read_bytes()))


class ThePlant(AtThePaceOfTheClock):
    """The robot moves by corrections that cease in the midst of the contour."""

    MOVED = 1e-5  # rad

    def largest_of(self, received):
        return max((abs(value) for row in corrections(received) for value in row), default=0.0)

    def start_milling(self, run):
        """A plant whose robot is being corrected."""
        for _ in range(self.ATTEMPTS):
            self.start(self.job)
            peer = self.client()
            plant = subprocess.Popen([BIN / "flexcomp", "plant", "--model", self.job.model, "--path", self.job.path,
                                      "--period", str(self.PERIOD), "--bus", f"can:{BUS}", "--out", run],
                                     stdout=subprocess.DEVNULL)
            while plant.poll() is None:
                if self.largest_of(peer.receive(0.5)) > self.MOVED:
                    return plant
        raise AssertionError("it never corrects")

    def mill_while(self, order):
        """Motion of the robot's second joint, in rad, while `order` happens to the board."""
        run = self.folder / "run.csv"
        plant = self.start_milling(run)
        time.sleep(2)  # the contour takes six
        ask(order)
        self.assertEqual(0, plant.wait(timeout=60))
        with open(run, newline="") as file:
            return [float(row["q_meas_2"]) - float(row["q_cmd_2"]) for row in csv.DictReader(file)]

    def assert_held_faded_and_zero(self, moved):
        largest = max(map(abs, moved))
        self.assertGreater(largest, self.MOVED)
        self.assertEqual(0, moved[-1])
        steps = [abs(b - a) for a, b in zip(moved, moved[1:])]
        self.assertLess(max(steps), 0.15 * largest, "no jump")
        first_zero = next(i for i, value in enumerate(moved) if value == 0)
        self.assertEqual({0}, set(moved[first_zero:]), "zero until armed again")

    def test_when_the_line_is_cut_it_holds_and_fades_and_stays_at_zero(self):
        self.assert_held_faded_and_zero(self.mill_while("cut"))

    def test_when_the_processor_is_reset_it_holds_and_fades_and_stays_at_zero(self):
        self.assert_held_faded_and_zero(self.mill_while("reset"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
