"""The main job on a bus: real flexcompd, real bus, real plant; four robots, CAN and LCM, in lock-step."""

import csv
import json
import unittest

from bench_on_a_bus import BUS, LCM, ROBOTS, Flexcompd, HilTest, Job, flexcomp, lcm_logger
from circle_on_a_bus import LARGEST_SHARE, CircleTest, mill


def positions(recording):
    """How many rows hold a TCP position."""
    with open(recording, newline="") as file:
        return sum(bool(row["x"]) for row in csv.DictReader(file))


class Circle(CircleTest):
    def test_four_robots_over_can(self):
        for robot in ("kr100", "kr270", "kr360", "kr500"):
            with self.subTest(robot=robot):
                self.assertLessEqual(self.share(robot, f"can:{BUS}", ("--can", BUS)), LARGEST_SHARE)

    def test_four_robots_over_lcm(self):
        for robot in ("kr100", "kr270", "kr360", "kr500"):
            with self.subTest(robot=robot):
                self.assertLessEqual(self.share(robot, f"lcm:{LCM}", ("--lcm", LCM)), LARGEST_SHARE)

    def test_over_lcm_the_log_gives_the_same_circularity(self):
        log = self.folder / "run.lcmlog"
        # Lock-step does not wait for the logger, which may try again where it missed messages.
        for _ in range(3):
            share = self.share("kr270", f"lcm:{LCM}", ("--lcm", LCM), log=lcm_logger(log))
            self.assertLessEqual(share, LARGEST_SHARE)
            flexcomp("convert", log, "--out", self.folder / "converted.csv")
            if positions(self.folder / "converted.csv") == positions(self.folder / "run.csv"):
                return self.assert_log_gives_the_same(log)
        self.fail("lcm-logger missed messages in every one of three runs")


class MovingRobot(HilTest):
    """Not at rest at every moment: links and motors as differential equations, by the design of its
    joints' control."""

    def test_a_robot_that_moves_on_its_springs_is_corrected_too(self):
        job = Job(self.folder, "kr360", 0.1)
        moving = ("--dynamic", ROBOTS / "kr360" / "arc.yaml")
        before, _ = mill(job, self.folder / "without.csv", "--table", job.table, "--without-compensation", *moving)
        with Flexcompd(job, "--trigger", "lockstep") as node:
            after, _ = mill(job, self.folder / "run.csv", "--bus", f"can:{BUS}", "--lockstep", *moving)
            self.assertEqual(0, node.stop())
        print(f"moving: {1e3 * before:.4f} mm without, {1e3 * after:.4f} mm with")
        # The rest is the servo's own error, which the compensator does not know.
        self.assertLess(after, 0.75 * before)


class LoopGain(HilTest):
    def test_a_process_that_would_make_the_loop_unstable_is_refused_with_the_largest_safe_gain(self):
        process = ("--depth-of-cut", 0.001, "--material", "outside")
        job = Job(self.folder, "kr270", 0.1, *process, "--loop-filter-cutoff", 20)
        with Flexcompd(job, "--trigger", "lockstep", "--gain", 1) as node:
            said = flexcomp("plant", "--model", job.model, "--path", job.path, "--bus", f"can:{BUS}",
                            "--lockstep", *process, code=1)
            self.assertIn("not armed: the gain is above the largest safe one", said)
            self.assertIn("largest safe gain", node.messages())
            self.assertEqual(0, node.stop())

    def test_without_the_guard_a_shallow_cut_is_unstable_and_a_lower_gain_in_a_deeper_one_is_not(self):
        job = Job(self.folder, "kr270", 0.1)

        def cut(depth, *words):
            return json.loads(flexcomp("plant", "--model", job.model, "--path", job.path, "--table", job.table,
                                       "--depth-of-cut", depth, "--filter-cutoff", 0, "--json", *words))

        steady = cut(0.0012, "--gain", 0.3)
        self.assertGreater(steady["least_engagement"], 0.9)
        self.assertLess(steady["most_engagement"], 2)
        wild = cut(0.0008, "--allow-unstable")
        self.assertEqual(0, wild["least_engagement"], "the tool bounces out of the cut")
        self.assertGreater(wild["most_engagement"], 3)


if __name__ == "__main__":
    unittest.main(verbosity=2)
