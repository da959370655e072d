"""The scorer of diagnoses: a perfect tool scores 100 %, one that says nothing 0."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from scoring import answer, figures, judge, table  # noqa: E402
import fake_tool  # noqa: E402


def truth_of(family, effects=(), foreign=None, seed=0):
    return {"family": family, "seed": seed, "kind": "circle", "effects": list(effects),
            "foreign": foreign, "noise_rms": {"tcp_position": 2e-5}, "columns": ["xyz"]}


def effect(name, joint, equivalents=(), **parameters):
    return {"effect": name, "joint": joint, "parameters": parameters, "units": {},
            "equivalents": [{"effect": other, "joint": place} for other, place in equivalents]}


def judged(truth, change=lambda diagnosis: None, manner="perfect"):
    diagnosis = fake_tool.answer(truth, manner)
    change(diagnosis)
    return judge.judge(truth, answer.parse(json.dumps(diagnosis)), 1.0)


def name_instead(name, joint):
    def change(diagnosis):
        diagnosis["findings"][0].update(effect=name, joint=joint)
    return change


class Judging(unittest.TestCase):
    def setUp(self):
        self.truth = truth_of("single", [effect("backlash", 2, [("hysteresis", 2)], gap=2e-4)])

    def test_the_concealed_effect_at_its_joint_is_right(self):
        self.assertEqual("exact", judged(self.truth).first)

    def test_the_right_effect_at_another_joint_is_wrong(self):
        self.assertEqual("wrong", judged(self.truth, name_instead("backlash", 3)).first)

    def test_an_equivalent_counts_but_apart(self):
        self.assertEqual("equivalent", judged(self.truth, name_instead("hysteresis", 2)).first)

    def test_a_group_of_the_tool_is_told_apart_from_being_right(self):
        def change(diagnosis):
            name_instead("joint_offset", 2)(diagnosis)
            diagnosis["indistinguishable"] = [[{"effect": "joint_offset", "joint": 2},
                                               {"effect": "backlash", "joint": 2}]]
        result = judged(self.truth, change)
        self.assertEqual("group", result.first)
        self.assertEqual(0, result.found)
        self.assertEqual(0.0, figures.figures([result])["single: right effect and joint first"].value)

    def test_groups_may_be_written_as_names(self):
        self.assertEqual(("backlash", 2), answer._member("backlash of joint 2"))
        self.assertEqual(("payload", "any"), answer._member("payload"))

    def test_a_second_finding_that_is_wrong_costs_precision(self):
        truth = truth_of("pair", [effect("backlash", 2), effect("payload", None)])

        def change(diagnosis):
            diagnosis["findings"].append(fake_tool.finding(effect("wrench_bias", None)))
        found = figures.figures([judged(truth, change)])
        self.assertEqual(1.0, found["pair: recall"].value)
        self.assertAlmostEqual(2 / 3, found["pair: precision"].value)

    def test_the_same_effect_named_twice_is_right_once(self):
        truth = truth_of("pair", [effect("backlash", 2), effect("payload", None)])
        result = judged(truth, lambda diagnosis: diagnosis["findings"].__setitem__(
            1, diagnosis["findings"][0]))
        self.assertEqual((1, 1, 2), (result.found, result.right_findings, result.findings))

    def test_foreign_physics_that_a_catalogue_has_by_now_is_rightly_named(self):
        truth = truth_of("foreign", foreign={"name": "load_friction", "joint": 5})
        for named, claims in ((("load_friction", 5), False), (("load_friction", 4), True),
                              (("coulomb_friction", 5), True)):
            with self.subTest(named=named):
                findings = [fake_tool.finding(effect(*named))]
                result = judged(truth, lambda diagnosis, found=findings: diagnosis.update(
                    verdict="explained", findings=found))
                self.assertIs(claims, result.claims)

    def test_any_finding_in_foreign_physics_is_a_wrong_claim(self):
        truth = truth_of("foreign", foreign={"name": "tracker_walk"})

        def change(diagnosis):
            diagnosis["verdict"] = "partly_explained"
            diagnosis["findings"] = [fake_tool.finding(effect("backlash", 2))]
        self.assertEqual(1.0, figures.figures([judged(truth, change)])[
            "foreign: confident wrong findings"].value)

    def test_any_mismatch_in_a_clean_recording_is_a_false_alarm(self):
        result = judged(truth_of("clean"), lambda diagnosis: diagnosis.update(verdict="unexplained"))
        self.assertTrue(result.alarm)

    def test_no_answer_counts_as_wrong_everywhere(self):
        results = [judge.failed(truth_of("clean"), "failed: exit 3", 1.0),
                   judge.failed(truth_of("foreign", foreign={"name": "x"}), "failed: exit 3", 1.0),
                   judge.failed(self.truth, "failed: exit 3", 1.0)]
        found = figures.figures(results)
        self.assertEqual(1.0, found["clean: false alarms"].value)
        self.assertEqual(1.0, found["foreign: confident wrong findings"].value)
        self.assertEqual(0.0, found["single: right effect and joint first"].value)

    def test_parameters_are_compared_with_their_interval(self):
        self.assertEqual((1, 1), (judged(self.truth).covered, judged(self.truth).compared))

        def far(diagnosis):
            diagnosis["findings"][0]["parameters"]["gap"]["value"] = 3e-4
        self.assertEqual((0, 1), (judged(self.truth, far).covered, judged(self.truth, far).compared))

    def test_an_answer_against_the_contract_is_refused(self):
        for change in (lambda d: d.pop("location"), lambda d: d.update(verdict="sure"),
                       lambda d: d["findings"][0].update(joint=7), lambda d: d["final"].clear(),
                       lambda d: d.update(verdict="no_mismatch")):
            with self.assertRaises(answer.Malformed):
                judged(self.truth, change)


class Statistics(unittest.TestCase):
    def test_the_interval_of_clopper_and_pearson(self):
        low, high = figures.Rate(10, 10).interval  # (0.025)^(1/10) in closed form
        self.assertAlmostEqual(0.025**0.1, low, 9)
        self.assertEqual(1.0, high)
        self.assertAlmostEqual(1 - 0.025**0.1, figures.Rate(0, 10).interval[1], 9)

    def test_the_table_counts_joints_apart(self):
        truth = truth_of("single", [effect("backlash", 2)])
        counts, elsewhere = table.confusion([judged(truth), judged(truth, name_instead("backlash", 3)),
                                             judged(truth, manner="empty")])
        self.assertEqual({"backlash": 2, table.NOTHING: 1}, dict(counts["backlash"]))
        self.assertEqual(1, elsewhere["backlash"])


class Command(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        cls.tool = cls.folder / "flexcomp"
        cls.tool.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{HERE / "fake_tool.py"}" "$@"\n')
        cls.tool.chmod(0o755)

    def score(self, manner):
        done = subprocess.run(
            [sys.executable, "-m", "scoring", "--seed", "3", "--single", "2", "--pairs", "1", "--clean",
             "2", "--foreign", "1", "--jobs", "2", "--keep", str(self.folder / "trials"), "--tool",
             str(self.tool)], capture_output=True, text=True,
            env=os.environ | {"FAKE_ANSWER": manner, "PYTHONPATH": str(HERE)})
        scores = self.folder / "trials" / "scores.json"
        self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertEqual("", done.stderr)
        return done, json.loads(scores.read_text())["figures"]

    def rates(self, scored):
        return [scored[name]["rate"] for name in (
            "single: right effect and joint first", "pair: recall", "clean: false alarms",
            "foreign: confident wrong findings")]

    def test_a_perfect_tool_meets_every_goal(self):
        done, scored = self.score("perfect")
        self.assertEqual([1.0, 1.0, 0.0, 0.0], self.rates(scored))
        self.assertEqual(0, done.returncode, done.stdout)
        self.assertEqual(7, len((self.folder / "trials" / "cases.csv").read_text().splitlines()))

    def test_a_silent_tool_finds_nothing(self):
        done, scored = self.score("empty")
        self.assertEqual([0.0, 0.0, 0.0, 0.0], self.rates(scored))
        self.assertEqual(1, done.returncode)
        self.assertIn("MISSED  single", done.stdout)

    def test_a_tool_that_fails_is_wrong_everywhere(self):
        for manner in ("broken", "absent"):
            done, scored = self.score(manner)
            self.assertEqual([0.0, 0.0, 1.0, 1.0], self.rates(scored))
            self.assertEqual(6, scored["runs without an answer"]["k"])
            self.assertEqual(1, done.returncode)


if __name__ == "__main__":
    unittest.main()
