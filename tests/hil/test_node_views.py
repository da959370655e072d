"""`flexcomp node status` and `node monitor` while the Python client drives flexcompd in lock-step."""

import contextlib
import json
import math
import os
import pathlib
import pty
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import urllib.request

sys.path.insert(0, str(pathlib.Path(os.environ["FLEXCOMP_BUILD"]) / "python"))

import flexcomp
from bench_on_a_bus import BIN, BUS, LCM, Flexcompd, HilTest, Job
from bench_on_a_bus import flexcomp as command
from circle_on_a_bus import LOCKSTEP_FEED, LOCKSTEP_PERIOD

STEP = 2e-7  # rad, of an angle on the bus
SETPOINTS_RECEIVED, SETPOINTS_LOST = "16", "17"  # names of statistics


class Driver:
    """Cycles along the path, slowly enough for who listens, until it is stopped."""

    def __init__(self, job, client):
        recording = flexcomp.Recording.read(job.path)
        self.rows = list(zip(recording.group("q_cmd"), recording.group("wrench")))
        self.client = client
        self.wrench = None  # instead of the path's
        self.sent = []
        self.last = None
        self._stops = False

    def cycle(self):
        q, wrench = self.rows[len(self.sent) // 4 % len(self.rows)]
        self.sent.append(tuple(q))
        self.last = self.client.cycle(q, wrench if self.wrench is None else self.wrench)
        time.sleep(0.002)
        return self.last

    def _run(self):
        while not self._stops:
            self.cycle()

    @contextlib.contextmanager
    def running(self):
        thread = threading.Thread(target=self._run)
        thread.start()
        try:
            yield
        finally:
            self._stops = True
            thread.join()
            self._stops = False


class NodeViews(HilTest):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.job = Job(scratch.name, "kr270", LOCKSTEP_FEED, radius=0.05, period=LOCKSTEP_PERIOD)

    def setUp(self):
        super().setUp()
        self.node = self.enterContext(Flexcompd(self.job, "--trigger", "lockstep"))
        self.client = flexcomp.Client(BUS, int(self.job.model_hash, 16), period=LOCKSTEP_PERIOD, lockstep=True)
        self.addCleanup(self.client.close)
        self.driver = Driver(self.job, self.client)

    def status(self, *options, code=0):
        return json.loads(command("node", "status", "--bus", f"can:{BUS}", "--json", *options, code=code))

    def monitor(self, *options, **more):
        return subprocess.Popen([BIN / "flexcomp", "node", "monitor", "--bus", f"can:{BUS}", *map(str, options)],
                                text=True, **more)

    def test_status_says_state_correction_deflection_and_the_nodes_own_counts(self):
        self.client.arm(self.driver.cycle)
        with self.driver.running():
            told = self.status("--model", self.job.model)
        self.assertEqual(("active", [], []), (told["state"], told["faults"], told["latched"]))
        self.assertEqual(self.job.model_hash, told["model_hash"])
        for correction, deflection in zip(told["correction"], told["deflection"]):
            # The spring's wind-up is what is corrected; it moves on while the wrench is filtered.
            self.assertAlmostEqual(-deflection, correction, delta=1e-4)
        self.assertGreater(max(map(abs, told["correction"])), 2e-4)
        self.assertGreater(told["statistics"][SETPOINTS_RECEIVED], 100)
        self.assertEqual(0, told["statistics"][SETPOINTS_LOST])

    def test_a_fault_is_told_in_words_and_by_the_exit_code(self):
        self.client.arm(self.driver.cycle)
        self.driver.wrench = [math.nan] * 6
        with self.driver.running():
            time.sleep(1)
            told = self.status(code=1)
        self.assertEqual("latched", told["state"])
        self.assertIn("wrench not finite", told["faults"] + told["latched"])

    def test_the_monitor_records_what_the_controller_sent(self):
        record = self.folder / "recorded.csv"
        self.client.arm(self.driver.cycle)
        watching = self.monitor("--record", record, "--json", stdout=subprocess.PIPE)
        self.assertTrue(json.loads(watching.stdout.readline())["time"] < 1)  # it listens
        first = len(self.driver.sent)
        for _ in range(300):
            self.driver.cycle()
        time.sleep(0.3)
        watching.send_signal(signal.SIGINT)
        lines = watching.communicate(timeout=20)[0].splitlines()
        self.assertEqual(0, watching.returncode)
        self.assertGreater(len(lines), 3)
        self.assertEqual("active", json.loads(lines[-1])["state"])
        recorded = flexcomp.Recording.read(record)
        self.assertEqual(["q_cmd", "wrench"], list(recorded.groups))
        sent = self.driver.sent[first:]
        self.assertEqual(len(sent), len(recorded.time))
        for one, other in zip(sent, recorded.group("q_cmd")):
            self.assertLess(max(abs(one - other)), STEP)

    def test_a_recording_of_nothing_is_refused_and_leaves_no_file(self):
        record = self.folder / "nothing.csv"
        with self.monitor("--record", record, "--seconds", 0.5, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE) as watching:
            self.assertIn("at least two setpoints", watching.stderr.read())
        self.assertEqual((2, False), (watching.returncode, record.exists()))

    def test_on_a_terminal_the_view_stays_in_its_place_and_the_cursor_comes_back(self):
        near, far = pty.openpty()
        with self.driver.running(), self.monitor("--seconds", 1, stdout=far) as watching:
            self.assertEqual(0, watching.wait(timeout=20))
        os.close(far)
        seen = b""
        with contextlib.suppress(OSError):  # the end of a terminal that nobody has open any more
            while part := os.read(near, 4096):
                seen += part
        os.close(near)
        text = seen.decode()
        self.assertTrue(text.startswith("\033[2J\033[?25l") and text.endswith("\033[?25h"))
        views = text.split("\033[H")[1:]
        self.assertGreater(len(views), 3)
        self.assertIn("setpoints", views[-1])

    def test_the_page_shows_what_the_monitor_hears(self):
        with self.driver.running(), self.monitor("--web", 0, "--json", "--seconds", 10, stdout=subprocess.DEVNULL,
                                                 stderr=subprocess.PIPE) as watching:
            address = watching.stderr.readline().split()[1]
            with urllib.request.urlopen(address + "events", timeout=10) as events:
                told = json.loads(events.readline()[len("data: "):])
            watching.terminate()
            self.assertEqual(0, watching.wait(timeout=20))
        self.assertEqual("off", told["state"])

    def test_the_monitor_sends_nothing(self):
        with open(self.folder / "log", "w+") as log:
            dump = subprocess.Popen(["candump", "-L", BUS], stdout=log)
            time.sleep(0.5)
            with self.monitor("--seconds", 1, stdout=subprocess.DEVNULL) as watching:
                self.assertEqual(0, watching.wait(timeout=20))
            time.sleep(0.3)
            dump.send_signal(signal.SIGINT)
            dump.wait()
            log.seek(0)
            self.assertEqual("", log.read())  # in lock-step a node without setpoints is silent too

    def test_where_nobody_is_status_says_so(self):
        self.node.stop()
        for bus in (f"can:{BUS}", f"lcm:{LCM}"):
            done = subprocess.run([BIN / "flexcomp", "node", "status", "--bus", bus], capture_output=True, text=True)
            self.assertEqual((2, f"flexcomp: {bus}: nobody answers\n"), (done.returncode, done.stderr))


if __name__ == "__main__":
    unittest.main(verbosity=2)
