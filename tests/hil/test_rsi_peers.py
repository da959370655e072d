"""flexcompd --rsi against a simulator of RSI by others: the echo server of RSIPI (PyPI), which tools/setup installs."""

import copy
import csv
import importlib.util
import math
import pathlib
import sys
import time
import types
import unittest

from bench_on_a_bus import Flexcompd, HilTest, Job
from rsi_bench import AXES, free_port

SKIPPED = 77  # an exit code, for ctest


def echo_server():
    """Its class, without the rest of the package, which wants libraries for plots; None if it is not installed."""
    found = importlib.util.find_spec("RSIPI")
    if found is None:
        return None
    package = types.ModuleType("RSIPI")
    package.__path__ = list(found.submodule_search_locations)
    sys.modules["RSIPI"] = package
    return importlib.import_module("RSIPI.rsi_echo_server").EchoServer


EchoServer = echo_server()

# Its own elements, and those of its configuration that matter here.
CONFIGURATION = """<ROOT><CONFIG><IP_NUMBER>127.0.0.1</IP_NUMBER><PORT>{port}</PORT><SENTYPE>ImFree</SENTYPE>
<ONLYSEND>FALSE</ONLYSEND></CONFIG><SEND><ELEMENTS>{sent}</ELEMENTS></SEND>
<RECEIVE><ELEMENTS>{received}</ELEMENTS></RECEIVE></ROOT>"""


def configuration(port):
    internal = "".join(f'<ELEMENT TAG="DEF_{name}" TYPE="DOUBLE" INDX="INTERNAL"/>'
                       for name in ("RIst", "RSol", "AIPos", "ASPos", "Delay"))
    monitor = "".join(f'<ELEMENT TAG="AxisCorrMon.{axis}" TYPE="DOUBLE" INDX="{i + 1}"/>'
                      for i, axis in enumerate(AXES))
    received = "".join(f'<ELEMENT TAG="AKorr.{axis}" TYPE="DOUBLE" INDX="{i + 1}" HOLDON="0"/>'
                       for i, axis in enumerate(AXES))
    return CONFIGURATION.format(port=port, sent=internal + monitor, received=received)


@unittest.skipIf(EchoServer is None, "RSIPI is not installed")
class Rsipi(HilTest):
    def bring_up(self, mode):
        job = Job(self.folder, "kr270", 0.05, radius=0.05)
        job.be_patient()
        port = free_port()
        file = self.folder / "ethernet.xml"
        file.write_text(configuration(port))
        server = EchoServer(str(file), delay_ms=4, mode=mode, timeout_packets=1000)
        self.addCleanup(server.stop)
        with job.path.open() as path:
            self.stand(server, next(csv.DictReader(path)))
        # It sends positions in steps of 0.01 degree, and as it corrects, the corrected ones as setpoint.
        node = Flexcompd(job, "--rsi-mode", mode, "--rsi-correction", "AKorr", "--rsi-wrench", "FT", "--rsi-arm",
                         "Arm", "--rsi-applied", "AxisCorrMon", "--without-identity", "--priority", "0",
                         bus=("--rsi", f"udp://127.0.0.1:{port}"))
        self.addCleanup(node.__exit__)
        server.start()
        return server, node

    def stand(self, server, row):
        """At the beginning of the path, in the cut."""
        for name in ("AIPos", "ASPos"):
            server.state[name] = {axis: math.degrees(float(row[f"q_cmd_{i + 1}"])) for i, axis in enumerate(AXES)}
        server.base_pose = {name: copy.deepcopy(value) for name, value in server.state.items()
                            if isinstance(value, dict)}
        server.state["Arm"] = 0
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
