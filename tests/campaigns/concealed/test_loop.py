"""The loop closed on the plant: a right model makes the circle round, the nominal one does not."""

import os
import pathlib
import sys
import tempfile
import unittest

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import loop  # noqa: E402
from campaign import case as campaign_case  # noqa: E402

TOOL = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"
CASE = campaign_case.Case("effect", "circle", ("joint_stiffness",), (3, 1, 1))


def with_compliance(model, joint, change, path):
    """The model with another compliance of a joint (1 to 6)."""
    text = yaml.safe_load(model.read_text())
    name = list(text["joints"])[joint - 1]
    text["joints"][name]["compliance"] += change
    text["urdf"] = str(model.parent / text["urdf"])
    path.write_text(yaml.safe_dump(text))
    return path


class Loop(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        folder = pathlib.Path(cls.scratch.name)
        cls.effect = campaign_case.rebuild(CASE, folder / "case").effects[0]
        cls.nominal = folder / "case" / "model" / "robot.yaml"
        right = with_compliance(cls.nominal, cls.effect.joint,
                                cls.effect.parameters["compliance_change"], folder / "right.yaml")
        cls.closed = loop.close(TOOL, CASE, cls.nominal, right)

    def test_the_core_takes_nearly_all_of_the_deflection_away(self):
        self.assertLess(self.closed["without"], 0.05 * self.closed["uncorrected"])

    def test_the_right_model_makes_the_circle_as_round_as_without_what_is_concealed(self):
        self.assertGreater(self.closed["nominal"], 1.5 * self.closed["without"])
        self.assertLess(self.closed["diagnosed"], 1.1 * self.closed["without"])

    def test_a_model_that_is_refused_is_said(self):
        broken = self.nominal.with_name("broken.yaml")
        broken.write_text("joints: 7\n")
        self.assertIn("flexcomp table: exit 2", loop.close(TOOL, CASE, broken, broken)["failed"])

    def test_one_case_of_each_effect_is_picked_and_no_pair(self):
        truths = {name: {"truth": {"effects": [{"effect": effect} for effect in effects]}}
                  for name, effects in (("000", ("a", "b")), ("001", ("b",)), ("002", ()),
                                        ("003", ("b",)), ("004", ("a",)))}
        self.assertEqual({"001": "b", "004": "a"}, loop.pick(truths))


if __name__ == "__main__":
    unittest.main()
