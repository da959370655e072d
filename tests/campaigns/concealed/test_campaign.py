"""The campaign: its mix, that a seed gives the same files again, and that names tell nothing."""

import collections
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import campaign  # noqa: E402
from campaign import catalogue, kinds, paths  # noqa: E402
from campaign.case import ACCEPTED, Case  # noqa: E402
from plant import sensors  # noqa: E402

TOOL = pathlib.Path(os.environ.get("FLEXCOMP_BIN", "")) / "flexcomp"
SHORT = {kind: (3.0, 4.0) for kind in kinds.SECONDS}


def write(case, folder):
    """Writes a case with shorter recordings than usual."""
    folder.mkdir()
    with unittest.mock.patch.multiple(kinds, SECONDS=SHORT, POSES=3):
        return campaign.write_case(case, folder)


def files(folder):
    return {str(path.relative_to(folder)): path.read_bytes()
            for path in sorted(folder.rglob("*")) if path.is_file()}


def rounded(truth):
    """Without the last digits, in which sums differ where arrays lie otherwise in memory."""
    return json.loads(json.dumps(truth), parse_float=lambda number: float(f"{float(number):.9g}"))


def table(path):
    """{column: values} of a CSV."""
    with open(path, encoding="utf-8") as file:
        header = file.readline().strip().split(",")
    return dict(zip(header, np.genfromtxt(path, delimiter=",", skip_header=1, ndmin=2).T))


class Drawing(unittest.TestCase):
    def test_a_hundred_cases_hold_the_mix(self):
        cases = campaign.draw(5, 100)
        families = collections.Counter(case.family for case in cases)
        self.assertEqual({"effect": 70, "pair": 10, "clean": 10, "foreign": 10}, families)
        names = collections.Counter(case.names[0] for case in cases if case.family == "effect")
        self.assertEqual(set(catalogue.SINGLE), set(names))
        self.assertLessEqual(max(names.values()) - min(names.values()), 1)
        foreign = {case.names[0] for case in cases if case.family == "foreign"}
        self.assertGreaterEqual(len(foreign), 6)

    def test_the_same_seed_draws_the_same(self):
        self.assertEqual(campaign.draw(7, 40), campaign.draw(7, 40))
        self.assertNotEqual(campaign.draw(7, 40), campaign.draw(8, 40))

    def test_few_cases_are_drawn_too(self):
        self.assertEqual(3, len(campaign.draw(1, 3)))


class Regions(unittest.TestCase):
    def test_the_untrained_region_is_elsewhere(self):
        rng = np.random.default_rng(2)
        for _ in range(50):
            center = paths.posture(rng)
            near = np.abs(paths.nearby(rng, center) - center)
            far = np.abs(paths.far_from(rng, center) - center)
            self.assertTrue(np.all(far[:4] > near[:4]))
            self.assertGreater(far[0], 0.8)

    def test_recordings_stay_short_enough_to_be_read_whole(self):
        longest = max(seconds[1] for seconds in kinds.SECONDS.values())
        self.assertLess(longest * max(sensors.RATES), 8000)


class Writing(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name)

    def test_a_case_is_the_same_again_and_tells_nothing_by_its_names(self):
        case = Case("effect", "torque", ("viscous_friction",), (3, 1, 0))
        truth = write(case, self.scratch / "a")
        again = write(case, self.scratch / "b")
        self.assertEqual(rounded(truth), rounded(again))
        written, other = files(self.scratch / "a"), files(self.scratch / "b")
        self.assertEqual(list(written), list(other))
        for name in written:
            if name.endswith(".csv"):
                one, two = (table(self.scratch / folder / name) for folder in "ab")
                self.assertEqual(list(one), list(two))
                np.testing.assert_allclose(list(one.values()), list(two.values()), rtol=1e-9, atol=1e-9)
            else:
                self.assertEqual(written[name], other[name])
        urdf = next(name for name in written if name.endswith(".urdf"))
        self.assertEqual({"model/robot.yaml", urdf, "train.csv", "holdout.csv", "untrained.csv"},
                         set(written))
        robots = ("kr100", "kr270", "kr360", "kr500")
        self.assertIn(urdf, {f"model/{robot}.urdf" for robot in robots})
        for name in ("train", "holdout", "untrained"):
            time = table(self.scratch / "a" / f"{name}.csv")["t"]
            self.assertTrue(np.all(np.diff(time) > 0))
        for text in written.values():
            self.assertNotIn(b"viscous_friction", text)
        (effect,) = truth["effects"]
        self.assertEqual("viscous_friction", effect["effect"])
        self.assertTrue(ACCEPTED[0] <= effect["over_noise"] <= ACCEPTED[1])

    @unittest.skipUnless(TOOL.is_file(), "no flexcomp to compare with")
    def test_an_unchanged_robot_moves_as_flexcomp_simulates_it(self):
        for number, kind in enumerate(("static", "torque")):
            folder = self.scratch / kind
            truth = write(Case("clean", kind, (), (6, 1, number)), folder)
            simulated = folder / "simulated.csv"
            subprocess.run([TOOL, "simulate", "--model", folder / "model" / "robot.yaml",
                            "--recording", folder / "train.csv", "--out", simulated], check=True)
            measured, expected = table(folder / "train.csv"), table(simulated)
            columns = {"static": "xyz", "torque": [f"tau_{k}" for k in range(1, 7)]}[kind]
            (levels,) = truth["noise"].values()
            for column, level in zip(columns, levels):
                apart = measured[column] - expected[column]
                left = np.sqrt(np.nanmean(apart**2))
                swing = np.ptp(measured[column]) if kind == "torque" else 0
                self.assertLess(left, 1.2 * level + 0.01 * swing, column)


if __name__ == "__main__":
    unittest.main()
