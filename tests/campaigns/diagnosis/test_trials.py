"""A few trials of the diagnosis on recordings from the independent generator, and what it gives back.

tools/score-diagnosis runs hundreds. The seeds stand here for their kinds of recording and effects; any
others would do.
"""

import json
import os
import pathlib
import subprocess
import tempfile
import unittest

from generator import case
from scoring import answer, judge, trial

TORQUE, STATIC = 16, 23  # stribeck_friction, joint_stiffness
LINK_MASS = 4000097  # of which only the moments show, in a load test
LATE_WRENCH = 4000066  # a cutting force that changes from row to row, as noise does
CLEAN = 12
FOREIGN = 11
TOOL = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"


class Trials(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def diagnose(self, truth, model="robot.yaml", out="out", options=()):
        words = trial.command(TOOL, self.folder, truth, self.folder / out) + list(options)
        words[words.index("--model") + 1] = str(self.folder / model)
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stderr)
        return answer.parse((self.folder / out / "diagnosis.json").read_text())

    def result(self, family, seed):
        truth = case.write(family, seed, self.folder)
        found = self.diagnose(truth)
        return truth, found, judge.judge(truth, found, 0)

    def assert_named_and_given_back(self, seed):
        truth, found, result = self.result("single", seed)
        self.assertIn(result.first, judge.RIGHT, (truth["effects"], found.named))
        self.assertEqual(1, result.findings)
        for channel, ratio in result.holdout_ratio.items():
            self.assertLess(ratio, 1.15, channel)
        # With what was learnt the same recordings hold no mismatch any more.
        self.assertEqual("no_mismatch", self.diagnose(truth, "out/updated_model.yaml", "again").verdict)

    def test_an_effect_on_torques(self):
        self.assert_named_and_given_back(TORQUE)

    def test_an_effect_in_load_tests(self):
        self.assert_named_and_given_back(STATIC)

    def test_a_mass_that_pulls_as_a_balancer_would_is_named_with_it(self):
        _, found, result = self.result("single", LINK_MASS)
        self.assertIn(result.first, judge.RIGHT, found.named)
        said = json.loads((self.folder / "out" / "diagnosis.json").read_text())
        self.assertIn([{"effect": "link_mass", "joint": 2}, {"effect": "gravity_compensator", "joint": 2}],
                      said["indistinguishable"])

    def test_a_mismatch_as_fast_as_noise(self):
        truth, found, result = self.result("single", LATE_WRENCH)
        self.assertIn(result.first, judge.RIGHT, found.named)
        concealed = truth["effects"][0]["parameters"]["delay"]
        self.assertAlmostEqual(concealed, found.parameters[0]["delay"]["value"],
                               delta=0.05 * abs(concealed))

    def test_a_machine_like_its_model_is_left_alone(self):
        self.assertFalse(self.result("clean", CLEAN)[2].alarm)

    def test_physics_outside_the_catalogue_is_modelled_by_a_law_and_not_given_a_name(self):
        truth, found, result = self.result("foreign", FOREIGN)
        self.assertEqual({"law"}, {effect for effect, _ in found.named}, truth["foreign"])
        for channel, ratio in result.holdout_ratio.items():
            self.assertLess(ratio, 1.15, channel)

    def test_physics_outside_the_catalogue_is_told_with_its_place_where_no_law_is_sought(self):
        truth = case.write("foreign", FOREIGN, self.folder)
        found = self.diagnose(truth, options=["--law-seconds", "0"])
        said = json.loads((self.folder / "out" / "diagnosis.json").read_text())
        self.assertEqual(("unexplained", []), (found.verdict, found.named))
        self.assertTrue(said["unexplained"]["reason"])
        self.assertTrue(said["location"]["axes"] or said["location"]["joints"])


if __name__ == "__main__":
    unittest.main()
