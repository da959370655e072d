"""flexcompd --rsi against a simulator of RSI by others: the echo server of RSIPI (PyPI), which tools/setup installs."""

import copy
import csv
import importlib.util
import math
import os
import sys
import tempfile
import time
import types
import unittest

from bench_on_a_bus import Flexcompd, HilTest, Job, flexcomp
from rsi_bench import AXES, free_port

SKIPPED = 77  # an exit code, for ctest
SCRATCH = tempfile.TemporaryDirectory()


def echo_server():
    """Its class, without the rest of the package, which wants libraries for plots; None if it is not installed."""
    found = importlib.util.find_spec("RSIPI")
    if found is None:
        return None
    os.chdir(SCRATCH.name)  # it leaves a log where it is imported
    package = types.ModuleType("RSIPI")
    package.__path__ = list(found.submodule_search_locations)
    sys.modules["RSIPI"] = package
    return importlib.import_module("RSIPI.rsi_echo_server").EchoServer


EchoServer = echo_server()

@unittest.skipIf(EchoServer is None, "RSIPI is not installed")
class Rsipi(HilTest):
    def bring_up(self, mode):
        job = Job(self.folder, "kr270", 0.05, radius=0.05)
        files = self.configure(job, mode, free_port())
        server = EchoServer(str(files / "flexcomp.xml"), delay_ms=4, mode=mode, rsi_file=str(files / "flexcomp.rsi.xml"))
        self.assertEqual(100, server.timeout_packets)  # as the context says
        self.addCleanup(server.stop)
        with job.path.open() as path:
            self.stand(server, next(csv.DictReader(path)))
        # It sends positions in steps of 0.01 degree, and as it corrects, the corrected ones as setpoint.
        node = Flexcompd(job, "--rsi-correction", "AKorr", "--priority", "0", bus=())
        self.addCleanup(node.__exit__)
        server.start()
        return server, node

    def configure(self, job, mode, port):
        """The controller's files as flexcomp writes them. It knows corrections by one name alone."""
        files = self.folder / "controller"
        flexcomp("configure", "--model", job.model, "--table", job.table, "--out", job.config, "--rsi", files,
                 "--rsi-address", f"127.0.0.1:{port}", "--rsi-force", *(["--rsi-relative"] * (mode == "relative")))
        job.be_patient()
        ethernet = files / "flexcomp.xml"
        ethernet.write_text(ethernet.read_text().replace('"AK.', '"AKorr.'))
        return files

    def stand(self, server, row):
        """At the beginning of the path, in the cut."""
        for name in ("AIPos", "ASPos"):
            server.state[name] = {axis: math.degrees(float(row[f"q_cmd_{i + 1}"])) for i, axis in enumerate(AXES)}
        server.base_pose = {name: copy.deepcopy(value) for name, value in server.state.items()
                            if isinstance(value, dict)}
        self.press(server, 0)

    @staticmethod
    def press(server, count):
        noise = 0.1 * (count % 7)
        server.state["FT"] = {"Fx": 440 + noise, "Fy": 1370 - noise, "Fz": 635 + noise,
                              "Mx": 0.0, "My": 3.0, "Mz": 10.5}

    def wait_for(self, server, condition):
        for count in range(4000):
            if condition():
                return
            self.press(server, count)
            time.sleep(0.01)
        self.fail(f"correction {server.state['AxisCorrMon']}, {server.faulty_packets} faulty, {server.last_received}")

    def correct_and_stop(self, mode):
        server, node = self.bring_up(mode)
        largest = lambda: max(abs(server.state["AxisCorrMon"][axis]) for axis in AXES)
        self.wait_for(server, lambda: server.last_received is not None)
        for count in range(50):
            self.press(server, count)
            time.sleep(0.01)
        self.assertEqual(0, largest())
        server.state["Arm"] = 1
        self.wait_for(server, lambda: largest() > 0.02)
        server.state["Arm"] = 0
        # An answer that was late in relative mode is made up for by the one after it, which may differ by a step.
        left = 1e-6 if mode == "absolute" else 1e-6 + 0.05 * server.faulty_packets
        self.wait_for(server, lambda: largest() <= left)
        self.assertEqual(0, node.stop())
        counters = node.statistics()["setpoint"]
        self.assertEqual(0, counters["corrupt"] + counters["contradicting"])
        self.assertGreater(counters["received"], 100)

    def test_it_is_corrected_absolutely(self):
        self.correct_and_stop("absolute")

    def test_it_is_corrected_relatively(self):
        self.correct_and_stop("relative")


if __name__ == "__main__":
    if EchoServer is None:
        print("RSIPI is not installed")
        sys.exit(SKIPPED)
    unittest.main()
