"""The Python package drives a robot over the bus: the circle that it mills against the built-in plant's, and
what it does when answers cease."""

import csv
import os
import pathlib
import random
import statistics
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(os.environ["FLEXCOMP_BUILD"]) / "python"))

import flexcomp
from bench_on_a_bus import BUS, Flexcompd, HilTest, Job, circularity
from bench_on_a_bus import flexcomp as command
from circle_on_a_bus import LARGEST_SHARE, LOCKSTEP_FEED, LOCKSTEP_PERIOD, mill

FORCE_NOISE, MOMENT_NOISE = 1, 0.05  # N and N·m, as the built-in plant's sensor
COLUMNS = [f"q_cmd_{j}" for j in range(1, 7)]
WRENCH = ["fx", "fy", "fz", "mx", "my", "mz"]
PATIENT = {"period": LOCKSTEP_PERIOD, "lockstep": True}


class Path:
    """The program at any time, between its rows on straight lines."""

    def __init__(self, file):
        with open(file, newline="") as stream:
            rows = list(csv.DictReader(stream))
        self.times = [float(row["t"]) for row in rows]
        self.values = [[float(row[name]) for name in COLUMNS + WRENCH] for row in rows]
        self._row = 0

    def at(self, time):
        while self._row + 2 < len(self.times) and self.times[self._row + 1] <= time:
            self._row += 1
        start, end = self.times[self._row:self._row + 2]
        share = min(1.0, (time - start) / (end - start))
        values = [a + share * (b - a) for a, b in zip(*self.values[self._row:self._row + 2])]
        return values[:6], values[6:]


class PythonClient(HilTest):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.job = Job(scratch.name, "kr270", LOCKSTEP_FEED, radius=0.05, period=LOCKSTEP_PERIOD)

    def client(self, model_hash=None, **options):
        client = flexcomp.Client(BUS, int(model_hash or self.job.model_hash, 16), **(PATIENT | options))
        self.addCleanup(client.close)
        return client

    def node(self, *options):
        return Flexcompd(self.job, "--trigger", "lockstep", *options)

    def standing(self, client):
        """Cycles at the beginning of the path, in the cut."""
        q, wrench = Path(self.job.path).at(0)
        return lambda: client.cycle(q, wrench)

    def mill(self, client):
        """Where the robot was told to go, with the wrench on it; how round it became by `simulate`."""
        noise = random.Random(1)
        path = Path(self.job.path)
        client.arm(self.standing(client))
        with open(self.folder / "driven.csv", "w", newline="") as stream:
            writer = csv.writer(stream)
            writer.writerow(["t", *COLUMNS, *WRENCH])
            drives = client.cycle(*path.at(0)).drives
            for i in range(round(path.times[-1] / LOCKSTEP_PERIOD)):
                q, wrench = path.at(i * LOCKSTEP_PERIOD)
                correction = [a - b for a, b in zip(drives, path.at(max(0, i - 1) * LOCKSTEP_PERIOD)[0])]
                writer.writerow([i * LOCKSTEP_PERIOD, *(a + b for a, b in zip(q, correction)), *wrench])
                noisy = [w + noise.gauss(0, FORCE_NOISE if k < 3 else MOMENT_NOISE) for k, w in enumerate(wrench)]
                answer = client.cycle(q, noisy)
                self.assertEqual("active", answer.state_name)
                drives = answer.drives
        client.disarm(self.standing(client))
        command("simulate", "--model", self.job.model, "--path", self.folder / "driven.csv",
                "--out", self.folder / "driven_robot.csv")
        return circularity(self.folder / "driven_robot.csv")

    def test_its_circle_is_as_round_as_the_built_in_plants(self):
        before, _ = mill(self.job, self.folder / "without.csv", "--table", self.job.table, "--without-compensation")
        # The same frames as on a wire; each time with other noise of the sensor.
        built_in = [mill(self.job, self.folder / "plant.csv", "--table", self.job.table, "--seed", seed)[0]
                    for seed in range(1, 7)]
        mean, deviation = statistics.mean(built_in), statistics.stdev(built_in)
        with self.node() as node:
            mine = self.mill(self.client())
            self.assertEqual(0, node.stop())
        print(f"{1e6 * before:.1f} µm without, {1e6 * mean:.2f} ± {1e6 * deviation:.2f} µm by flexcomp plant, "
              f"{1e6 * mine:.2f} µm in Python")
        self.assertLessEqual(mine / before, LARGEST_SHARE)
        self.assertLess(abs(mine - mean), 4 * deviation)

    def test_over_fd_it_is_as_round(self):
        before, _ = mill(self.job, self.folder / "without.csv", "--table", self.job.table, "--without-compensation")
        with self.node("--fd") as node:
            self.assertLessEqual(self.mill(self.client(fd=True)) / before, LARGEST_SHARE)
            self.assertEqual(0, node.stop())

    def test_when_answers_cease_it_holds_then_fades_and_stays_at_zero_until_armed_again(self):
        client = self.client(hold_time=0.02, fade_time=0.1)
        q, wrench = Path(self.job.path).at(0)
        with self.node():
            client.arm(self.standing(client))
            held = client.cycle(q, wrench).drives
        client.lockstep = False  # nobody is there to wait for
        moved = [client.cycle(q, wrench) for _ in range(50)]
        self.assertEqual({False}, {answer.answered for answer in moved})
        self.assertEqual(held, moved[2].drives)
        largest = max(abs(a - b) for a, b in zip(held, q))
        steps = [max(abs(a - b) for a, b in zip(one.drives, other.drives)) for one, other in zip(moved, moved[1:])]
        self.assertLess(max(steps), 0.05 * largest, "no jump")
        self.assertEqual(tuple(q), moved[-1].drives)
        self.assertTrue(client.is_lost)
        client.lockstep = True
        with self.node():
            client.arm(self.standing(client))
            self.assertFalse(client.is_lost)
            self.assertEqual("active", client.cycle(q, wrench).state_name)

    def test_another_robot_is_refused_in_words(self):
        with self.node():
            client = self.client(model_hash="1")
            with self.assertRaisesRegex(flexcomp.Refused, "arm: the sender works with another robot, tool or payload"):
                client.arm(self.standing(client))

    def test_where_nobody_answers_arming_says_so(self):
        client = self.client(lockstep=False)
        with self.assertRaisesRegex(flexcomp.Refused, "arm: nobody answers"):
            client.arm(self.standing(client))


if __name__ == "__main__":
    unittest.main(verbosity=2)
