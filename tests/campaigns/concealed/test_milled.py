"""A circle on a machine with foreign physics: the true law makes it round, the nominal model does not."""

import os
import pathlib
import sys
import tempfile
import unittest

# Read when numpy is loaded. On matrices as small as these, threads only wait for one another.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402
import yaml  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from foreign import cases, milled, stand  # noqa: E402
from plant.motion import Motion  # noqa: E402

TOOL = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"
TRUTH = {"family": "alone", "kind": "poses", "foreign": {"effect": "zero_by_load"}, "known": None,
         "seed": [3, 3, 7]}


class Milled(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        folder = pathlib.Path(cls.scratch.name)
        _, (effect,) = cases.rebuild(cases.told(TRUTH), folder / "case")
        nominal = folder / "case" / "model" / "robot.yaml"
        text = yaml.safe_load(nominal.read_text())
        text["urdf"] = str(nominal.parent / text["urdf"])
        right = folder / "right.yaml"
        right.write_text(yaml.safe_dump(text | {"effects": effect.laws()}, allow_unicode=True))
        cls.row = milled.mill(TOOL, TRUTH, nominal, right)

    def test_what_a_joint_stands_off_by_spoils_the_circle(self):
        self.assertTrue(milled.is_judged(self.row), self.row)

    def test_the_true_law_mends_it(self):
        self.assertLess(milled.left(self.row), milled.GOAL, self.row)


class Judged(unittest.TestCase):
    def test_a_circle_counts_from_four_times_what_it_is_without(self):
        for nominal, counts in ((3.9e-5, False), (4.1e-5, True)):
            self.assertEqual(counts, milled.is_judged({
                "uncorrected": 1e-3, "without": 1e-5, "nominal": nominal, "diagnosed": nominal}))

    def test_a_circle_that_failed_does_not(self):
        self.assertFalse(milled.is_judged({"failed": "out of reach"}) or milled.is_judged({}))

    def test_only_laws_that_a_command_can_undo_are_asked_for(self):
        for exists, undone in ((True, True), (True, False), (False, True)):
            truth = {"foreign": {"exists": exists, "undone": undone}}
            self.assertEqual(exists and undone, milled.is_asked(truth))
        self.assertFalse(milled.is_asked({"foreign": None}))


class Encoder(unittest.TestCase):
    def test_a_servo_that_follows_its_encoder_stands_where_that_errs(self):
        effect = stand.EccentricEncoder(2, first=1e-3, first_phase=0, second=2e-3, second_phase=0)
        still = np.zeros((3, 6))
        q = still.copy()
        q[:, 1] = [0, np.pi / 4, np.pi / 2]
        motion = Motion(np.arange(3.0), q, still, still, still, np.zeros(3), 0.0)
        off = effect.driven(motion).q - q
        np.testing.assert_allclose(off[:, 1], [0, 1e-3 / np.sqrt(2) + 2e-3, 1e-3], atol=1e-12)
        self.assertFalse(np.delete(off, 1, axis=1).any())


if __name__ == "__main__":
    unittest.main()
