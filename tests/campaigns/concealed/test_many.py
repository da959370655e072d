"""Many small causes at once: the generator, the refits beside it, and the judge."""

import contextlib
import json
import os
import pathlib
import sys
import unittest
from unittest import mock

# Read when numpy is loaded. On matrices as small as these, threads only wait for one another.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from in_folder import InFolder  # noqa: E402
from many import __main__ as command  # noqa: E402
from many import (arm, cases, diagnosed, frame_refit, frames, friction, friction_refit,  # noqa: E402
                  intervals, judge, motions, plausible, robots)
from plant import description as descriptions  # noqa: E402
from rivals import recording  # noqa: E402


def nominal(folder, name="kr270", **words):
    robots.write_model(name, folder, np.array([0.05, 0.02, 0.1]), **words)
    return descriptions.load(folder / "robot.yaml")


@contextlib.contextmanager
def small():
    """Fewer rows, and without the packages of other robots, so that cases are the same everywhere."""
    with (mock.patch.object(robots, "available", lambda: ["kr100", "kr270", "kr360", "kr500"]),
          mock.patch.object(frame_refit, "ROWS", 120), mock.patch.object(frames, "RATE", 10.0)):
        yield


class TwoEngines(InFolder):
    """What NumPy's arm says is what the physics engine says."""

    def setUp(self):
        super().setUp()
        self.arm = nominal(self.folder)
        draw = np.random.default_rng(1)
        self.q, self.velocity, self.acceleration = draw.normal(size=(3, 4, 6))
        self.wrench = 100 * draw.normal(size=(4, 6))
        self.engine = frames._Body(self.arm)

    def test_the_tool_is_at_the_same_place(self):
        ours = arm.Frames(self.arm.chain, self.q).tip
        for row in range(4):
            np.testing.assert_allclose(ours[row], self.engine.place(self.q[row]), atol=1e-12)

    def test_weights_and_a_wrench_load_the_joints_alike(self):
        still = np.zeros(6)
        ours = arm.Frames(self.arm.chain, self.q).load(
            self.arm.chain, self.arm.gravity, (0.0, np.zeros(3)), self.wrench)
        for row in range(4):
            theirs = self.engine.load(self.q[row], still, still, self.wrench[row])
            np.testing.assert_allclose(ours[row], theirs, rtol=1e-9, atol=1e-6)

    def test_the_regressor_gives_the_torques_of_inverse_dynamics(self):
        ours = arm.regressor(self.arm.chain, self.arm.gravity, self.q, self.velocity,
                             self.acceleration) @ arm.lumped(self.arm.chain).ravel()
        for row in range(4):
            theirs = -self.engine.load(self.q[row], self.velocity[row], self.acceleration[row],
                                       np.zeros(6))
            np.testing.assert_allclose(ours[row], theirs, rtol=1e-9, atol=1e-6)


class Bodies(InFolder):
    def test_a_body_that_is_off_can_be(self):
        draw = np.random.default_rng(2)
        for joint in nominal(self.folder).joints * 5:
            friction._body_off(draw, joint.body)
            moments = np.linalg.eigvalsh(joint.body.inertia)
            self.assertGreater(joint.body.mass, 0)
            self.assertGreater(moments[0], 0)
            self.assertGreater(moments[0] + moments[1], moments[2])


class Friction(unittest.TestCase):
    drive = friction.Drive((10.0, 14.0), (2.0, 3.0), 0.0, 0.1, 0.0, 1e-4, 0.0, 0.0, 1.0, (0, 1, 0))

    def test_each_way_has_its_own(self):
        angle = np.concatenate([np.linspace(0, 1, 50), np.linspace(1, 0, 50)])
        velocity = np.repeat([1.0, -1.0], 50)
        found = friction.friction(self.drive, angle, velocity, np.zeros(100))
        self.assertAlmostEqual(found[49], 10 + 2, places=6)
        self.assertAlmostEqual(found[99], -14 - 3, places=6)

    def test_it_holds_while_standing(self):
        angle = np.array([0.0, 1.0, 1.0, 1.0])
        found = friction.friction(self.drive, angle, np.zeros(4), np.zeros(4))
        np.testing.assert_allclose(found[1:], 10.0)


class Courses(InFolder):
    def test_speeds_and_accelerations_are_those_of_the_angles(self):
        robot = nominal(self.folder)
        region, _ = motions.regions(np.random.default_rng(3), robot)
        course = motions.swing(np.random.default_rng(4), robot, region, 12.0, 1e-3, top=0.5,
                               share=0.5, within=0.8, rests=((4.0, 6.0, 0.02),))
        for values, slope in ((course.q, course.velocity), (course.velocity, course.acceleration)):
            np.testing.assert_allclose(np.gradient(values, 1e-3, axis=0)[2:-2], slope[2:-2],
                                       atol=2e-3)
        inside = (np.abs(course.q - region.center) <= region.half + 1e-9).all()
        self.assertTrue(inside)

    def test_the_region_nobody_trained_in_is_another_one(self):
        robot = nominal(self.folder)
        one, other = motions.regions(np.random.default_rng(3), robot)
        apart = np.abs(one.center - other.center)[:3] > 0.5 * one.half[:3]
        self.assertTrue(apart.any())


class Cases(InFolder):
    def setUp(self):
        super().setUp()
        self.enterContext(small())

    def written(self, kind, number):
        truth = cases.CLASSES[kind].write_case(5, number, self.folder)
        read = {part: recording.read(self.folder / f"{part}.csv") for part in cases.PARTS}
        return truth, read, descriptions.load(self.folder / "robot.yaml")

    def test_all_link_frames_fitted_leave_little_more_than_the_noise(self):
        truth, read, robot = self.written("frames", 0)
        self.assertEqual(truth["kind"], "poses")
        base = (frame_refit.base_tolerance(truth["base_compliance"])
                if truth["has_base_compliance"] else None)
        machine = frame_refit.Machine(robot, base=base)
        numbers = frame_refit.fit(machine, read["train"])
        left = {name: np.std(machine.places(values, frame_refit.Rows.of(read["holdout"]))
                             - read["holdout"].groups["xyz"])
                for name, values in (("nominal", 0 * numbers), ("fitted", numbers))}
        self.assertLess(left["fitted"], 3 * truth["noise"])
        self.assertGreater(left["nominal"], 10 * left["fitted"])

    def test_a_late_clock_shows_as_one(self):
        truth, read, robot = self.written("frames", 1)
        self.assertEqual(truth["kind"], "motion")
        machine = frame_refit.Machine(robot, clock=True)
        late = machine.part(frame_refit.fit(machine, read["train"]), "late")[0]
        self.assertAlmostEqual(late, truth["late"], delta=1e-3)

    def test_who_knows_the_structure_predicts_torques_well(self):
        truth, read, robot = self.written("friction", 0)
        _, model, cutoff = friction_refit.oracle(read["train"], robot, truth)
        left = cases.error("friction", read["holdout"], model.predict(
            friction_refit.Motion.of(read["holdout"], cutoff)))["rms"]
        plain = arm.regressor(robot.chain, robot.gravity, *(getattr(friction_refit.Motion.of(
            read["holdout"], cutoff), name) for name in ("q", "velocity", "acceleration")))
        before = cases.error("friction", read["holdout"], plain @ arm.lumped(robot.chain).ravel())
        self.assertLess(left, 0.2 * before["rms"])

    def test_the_same_seed_gives_the_same_case(self):
        first, _, _ = self.written("frames", 0)
        text = (self.folder / "train.csv").read_text()
        second, _, _ = self.written("frames", 0)
        self.assertEqual(first, second)
        self.assertEqual(text, (self.folder / "train.csv").read_text())


class Judging(InFolder):
    truth = {"class": "friction", "robot": "kr270", "transmission": np.eye(6).tolist(),
             "has": dict.fromkeys(("stribeck", "load", "gain", "payload", "coupled"), False),
             "payload": {"mass": 0.0}, "masses": [[100.0, 110.0]] * 6, "warming": 0.0, "warm": 50.0,
             "duration": 40.0,
             "drives": [{"dry": [10.0, 12.0], "viscous": [5.0, 5.0], "stick": 0.0, "by_load": 0.0,
                         "rotor": 3.0, "gain": 1.0, "offset": 0.0}] * 6}

    def finding(self, effect, joint=1, std=0.1, **values):
        return {"effect": effect, "joint": joint, "parameters": {
            name: {"value": value, "std": std} for name, value in values.items()}}

    def test_friction_of_the_wrong_sign_or_size_cannot_be(self):
        for torque, wrong in ((-1.0, True), (9.0, False), (500.0, True)):
            found = plausible.impossible([self.finding("coulomb_friction", torque=torque)], "{}",
                                         self.truth)
            self.assertEqual(bool(found), wrong, torque)

    def test_offsets_that_cancel_each_other_cannot_be(self):
        truth = {"class": "frames", "length": 2e-4, "angle": 2e-4}
        for size, wrong in ((7e-3, True), (4e-4, False)):
            found = plausible.impossible([self.finding("link_offset", 4, y=size)], "{}", truth)
            self.assertEqual(bool(found), wrong, size)

    def test_a_negative_number_of_the_model_cannot_be(self):
        text = "joints: {joint_a1: {compliance: 1e-6, viscous: -1e-1}}"
        self.assertTrue(plausible.impossible([], text, self.truth))

    def test_what_is_not_concealed_is_a_wrong_name(self):
        found = plausible.wrong_names([self.finding("coulomb_friction"), self.finding("resonance", 2)],
                                      self.truth)
        self.assertEqual(found, ["resonance 2"])

    def test_an_interval_is_held_to_the_mean_of_both_ways(self):
        findings = [self.finding("coulomb_friction", torque=11.1),
                    self.finding("coulomb_friction", torque=11.3)]
        inside = [row["inside"] for row in intervals.compared(findings, self.truth)]
        self.assertEqual(inside, [True, False])

    def test_worse_beyond_chance_is_worse_in_most_blocks(self):
        good = {"rms": 1.0, "blocks": [1.0, 1.1, 0.9, 1.0]}
        self.assertFalse(judge.beyond_chance({"rms": 1.01, "blocks": [1.1, 1.0, 1.0, 0.95]}, good))
        self.assertTrue(judge.beyond_chance({"rms": 1.2, "blocks": [1.2, 1.3, 1.1, 1.2]}, good))

    def test_a_case_without_an_answer_counts_as_missed(self):
        error = {"rms": 2.0, "all_rows": 2.0, "blocks": [2.0, 2.0]}
        better = {"rms": 1.0, "all_rows": 1.0, "blocks": [1.0, 1.0]}
        others = {name: dict.fromkeys(cases.PARTS, better) for name in ("nominal", "plain", "oracle")}
        run = {"code": None, "seconds": 300.0, "cpu": 290.0, "failures": ["flexcomp, holdout: gone"],
               "errors": {"nominal": dict.fromkeys(cases.PARTS, error), "flexcomp": {}}}
        (self.folder / "refit.json").write_text(json.dumps(others))
        (self.folder / "run.json").write_text(json.dumps(run))
        row = judge.judged("friction-00", self.truth, self.folder, self.folder)
        found = judge.figures([row])
        self.assertEqual(found["answered"], 0)
        self.assertEqual(found["holdout"]["within_oracle"]["count"], 0)
        self.assertEqual(row["holdout"]["over_plain"], 2.0)


CHEAT = """#!/usr/bin/python3
# Answers any recording with itself, as no honest tool can.
import json, pathlib, shutil, sys
words = dict(zip(sys.argv[2::2], sys.argv[3::2]))
if sys.argv[1] == "simulate":
    shutil.copyfile(words["--recording"], words["--out"])
else:
    out = pathlib.Path(words["--out"])
    out.mkdir()
    shutil.copyfile(words["--model"], out / "updated_model.yaml")
    shown = sorted(str(path) for path in pathlib.Path().iterdir())
    text = {"verdict": "explained", "findings": [], "final": {}, "shown": shown}
    (out / "diagnosis.json").write_text(json.dumps(text))
"""


class Command(InFolder):
    def test_a_campaign_runs_from_its_seed_to_its_summary(self):
        tool = self.folder / "tool"
        tool.write_text(CHEAT)
        tool.chmod(0o755)
        out = self.folder / "out"
        with small(), mock.patch("sys.stdout"), mock.patch("sys.stderr"):
            code = command.main(["--seed", "5", "--cases", "1", "--class", "frames", "--jobs", "1",
                                 "--tool", str(tool), "--out", str(out)])
        self.assertEqual(code, 0)
        found = json.loads((out / "summary.json").read_text())["figures"]["frames"]
        self.assertEqual(found["answered"], 1)
        self.assertEqual(found["holdout"]["within_both"]["count"], 1)
        answer = json.loads((out / "answers/frames-00/diagnosis.json").read_text())
        self.assertEqual(answer["shown"], sorted([*diagnosed.GIVEN, "out"]))


if __name__ == "__main__":
    unittest.main()
