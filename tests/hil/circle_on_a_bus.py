"""The circle that the tests mill on a bus, with compensation and without."""

import contextlib
import json

from bench_on_a_bus import Flexcompd, HilTest, Job, circularity, flexcomp

LARGEST_SHARE = 0.05  # of the circularity without compensation
# s. Robot controllers take corrections every 4 or every 12 ms. In real time the longer: a guest Linux
# that needs milliseconds for the frames of one cycle misses cycles of 4 ms.
LOCKSTEP_PERIOD, REAL_TIME_PERIOD = 0.004, 0.012
LOCKSTEP_FEED, REAL_TIME_FEED = 0.05, 0.025  # m/s


def mill(job, out, *options):
    """Circularity, and the share of the cycles without an answer in time."""
    run = json.loads(flexcomp("plant", "--model", job.model, "--path", job.path, "--out", out, "--json",
                              "--period", job.period, *options))
    return circularity(out), run["unanswered"] / run["ticks"]


class CircleTest(HilTest):
    def share(self, robot, bus, node_bus, *options, lockstep=True, log=None):
        """Circularity with compensation over that without; leaves run.csv, and a log of that run."""
        period, feed = ((LOCKSTEP_PERIOD, LOCKSTEP_FEED) if lockstep
                        else (REAL_TIME_PERIOD, REAL_TIME_FEED))
        job = Job(self.folder, robot, feed, radius=0.05, period=period)
        pace = ["--lockstep"] if lockstep else []
        trigger = ["--trigger", "lockstep"] if lockstep else []
        # A run without compensation needs no node, and is the same at every pace.
        before, _ = mill(job, self.folder / "without.csv", "--table", job.table, "--without-compensation")
        with Flexcompd(job, *trigger, *options, bus=node_bus) as node, log or contextlib.nullcontext():
            after, late = mill(job, self.folder / "run.csv", "--bus", bus, *pace)
            self.assertEqual(0, node.stop())
        print(f"{robot} {bus}: {1e3 * before:.4f} mm without, {1e3 * after:.4f} mm with, "
              f"{100 * after / before:.1f} %; {100 * late:.1f} % of the cycles without an answer in time")
        return after / before

    def assert_log_gives_the_same(self, log):
        converted = self.folder / "converted.csv"
        flexcomp("convert", log, "--out", converted)
        # Positions travel in steps of 0.2 µm.
        self.assertAlmostEqual(circularity(self.folder / "run.csv"), circularity(converted), delta=0.4e-6)
