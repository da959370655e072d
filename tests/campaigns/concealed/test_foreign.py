"""Foreign physics: the plant against closed forms, the draw, and the judge."""

import json
import os
import pathlib
import subprocess
import sys
import unittest
from unittest import mock

# Read when numpy is loaded. On matrices as small as these, threads only wait for one another.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402
from scipy.integrate import solve_ivp  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from campaign import case as campaign, cell  # noqa: E402
from foreign import __main__ as command  # noqa: E402
from foreign import cases, drives, judge, menu, sensors, stand, steady, trial, unseen  # noqa: E402
from foreign.law import Seen, lagged  # noqa: E402
from in_folder import InFolder  # noqa: E402
from many import arm  # noqa: E402
from plant import description as descriptions  # noqa: E402
from plant.motion import LoadTest, Motion, Signals  # noqa: E402
from rivals import recording  # noqa: E402

POSTURE = np.array([0.3, -1.2, 1.1, 0.4, 0.9, -0.5])


def seen(**values):
    """Rows of one moment each; keys such as q4 or v2."""
    count = len(next(iter(values.values())))
    arrays = {name: np.zeros((count, 6)) for name in ("q", "v", "a", "load")}
    for name, column in values.items():
        arrays[name[:-1]][:, int(name[-1]) - 1] = column
    return Seen(np.arange(count, dtype=float), **arrays)


class Drives(unittest.TestCase):
    def check(self, law, want, **values):
        np.testing.assert_allclose(law.extra(seen(**values)), want, atol=1e-9)

    def test_a_hose_hangs_at_rest_and_pulls_most_a_quarter_turn_off(self):
        law = drives.Hose(5, driver=4, torque=30, rest=0.2)
        self.check(law, [0, 30, -15], q4=[0.2, 0.2 + np.pi / 2, 0.2 - np.pi / 6])

    def test_cogging_turns_round_with_the_other_joint(self):
        law = drives.CoupledCogging(3, driver=2, torque=8, order=20, phase=0, middle=0.5)
        crest = np.pi / 40
        self.check(law, [8, 0, -8], q3=[crest] * 3, q2=[0.5, 0.5 + np.pi / 4, 0.5 + np.pi / 2])

    def test_windage_is_four_times_as_much_at_twice_the_speed(self):
        law = drives.Windage(2, driver=6, drag=3)
        self.check(law, [3, 12, -12], v6=[1, 2, -2])

    def test_a_detent_holds_at_its_angle(self):
        law = drives.Detent(4, torque=7, angle=0.6, width=0.1)
        self.check(law, [0, 7, -7, 0], q4=[0.6, 0.7, 0.5, 3.0])
        away = np.linspace(0.61, 0.8, 200)
        self.assertTrue((law.extra(seen(q4=away)) <= 7).all())

    def test_a_soft_stop_acts_beyond_its_angle_only(self):
        for side in (1, -1):
            law = drives.SoftStop(1, stiffness=100, angle=0.5, side=side)
            self.check(law, [0, 0, side * 20], q1=[0.5 - side * 0.3, 0.5, 0.5 + side * 0.2])

    def test_a_worn_stretch_rubs_within_its_width(self):
        law = drives.WornStretch(3, torque=5, angle=1.0, width=0.2)
        self.check(law, [5, -5, 5 / np.e, 0], q3=[1, 1, 1.2, 3], v3=[1, -1, 1, 1])

    def test_a_gear_rubs_while_it_drives(self):
        law = drives.DrivingFriction(2, torque=9)
        self.check(law, [9, -9, 0, 0], v2=[1, -1, 1, -1], a2=[2, -2, -2, 2])

    def test_a_neighbours_load_brakes(self):
        law = drives.NeighbourFriction(5, driver=3, share=0.02)
        self.check(law, [2, 2, -4], load3=[100, -100, 200], v5=[1, 1, -1])


class Lags(unittest.TestCase):
    def test_a_lag_solves_its_differential_equation(self):
        time = np.linspace(0, 8, 4001)
        drive = np.sin(time) + 0.3
        exact = solve_ivp(lambda t, y: (np.sin(t) + 0.3 - y) / 1.5, (0, 8), [0.3], t_eval=time,
                          rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(lagged(time, drive, 1.5), exact.y[0], atol=2e-3)

    def test_creep_comes_to_its_compliance_times_the_load(self):
        law = stand.Creep(2, compliance=1e-6, time=0.5)
        rows = seen(load2=np.r_[0.0, np.full(60, 400.0)])
        np.testing.assert_allclose(law.angle(rows)[[0, -1]], [0, 4e-4], atol=1e-12)

    def test_heat_follows_the_square_of_the_torque(self):
        law = sensors.HotDrive(2, loss=0.1, rated=100, time=2.0)
        time = np.linspace(0, 10, 2001)
        law.begin(None, Motion(time, *[np.zeros((2001, 6))] * 4, np.zeros(2001), run_in=4.0))
        torque = np.where(time > 6, 200.0, 0.0)
        heat = law.heat(time, torque)
        self.assertEqual(heat[np.searchsorted(time, 5.0)], 0)
        at = np.searchsorted(time, 8.0)
        self.assertAlmostEqual(heat[at], 4 * -np.expm1(-(time[at] - 6) / 2), delta=0.02)


class Places(unittest.TestCase):
    place = np.array([[1.5, -0.5, 1.0], [1.0, 0.8, 0.4]])

    def test_a_bent_rail_lifts_by_a_polynomial(self):
        law = stand.BentRail(None, along=1, axis=2, middle=0.3, bow=0.01, skew=0.002)
        want = self.place.copy()
        want[:, 2] += [0.01 * 0.64 - 0.002 * 0.512, 0.01 * 0.25 + 0.002 * 0.125]
        np.testing.assert_allclose(law.moved(None, self.place), want, atol=1e-12)

    def test_a_soft_floor_gives_on_one_side_only(self):
        law = stand.SoftFloor(None, axis=0, side=0.0, tilt=1e-3)
        found = law.moved(seen(q1=[0.0, np.pi]), self.place)
        sine, cosine = np.sin(1e-3), np.cos(1e-3)
        x, y, z = self.place[0]
        np.testing.assert_allclose(found[0], [x, cosine * y - sine * z, sine * y + cosine * z])
        np.testing.assert_allclose(found[1], self.place[1])

    def test_a_floor_hums_at_its_frequency(self):
        law = unseen.FloorHum(None, axis=1, amplitude=1e-4, frequency=2.0)
        law.begin(np.random.default_rng(1), None)
        rows = seen(q1=np.zeros(400))
        rows.time = np.arange(400) / 100
        power = np.abs(np.fft.rfft(law.moved(rows, np.zeros((400, 3)))[:, 1]))
        self.assertEqual(np.argmax(power), 8)
        self.assertAlmostEqual(power[8] / 200, 1e-4, places=9)

    def test_a_part_slips_once(self):
        law = unseen.SlippedPart(1, angle=2e-4)
        law.begin(np.random.default_rng(1), None)
        self.assertEqual(np.count_nonzero(np.diff(law.angle(seen(q1=np.zeros(50))))), 1)

    def test_an_encoder_runs_out_once_and_twice_a_turn(self):
        law = stand.EccentricEncoder(2, first=1e-4, first_phase=0.3, second=5e-5, second_phase=-1.0)
        turn = np.arange(360) * 2 * np.pi / 360
        lines = np.abs(np.fft.rfft(law.error(turn))) / 180
        np.testing.assert_allclose(lines[1:3], [1e-4, 5e-5], atol=1e-12)
        self.assertLess(lines[3:].max(), 1e-15)


class Sensors(unittest.TestCase):
    def signals(self, wrench):
        """Of a tool that is turned so that its x axis points along the base's y."""
        turn = Rotation.from_euler("z", 90, degrees=True).as_matrix()[None]
        still = np.zeros((1, 6))
        return Signals(np.zeros(1), still, still, still, still, np.array([wrench], float),
                       np.zeros((1, 3)), turn, np.zeros(1))

    def test_a_force_sensor_saturates_along_its_own_axis(self):
        shown = self.signals([300, 1000, 50, 1, 2, 3])
        sensors.ForceSaturation(None, axis=0, limit=500).sense(shown, None)
        want = [300, 500 * np.tanh(2), 50, 1, 2, 3]
        np.testing.assert_allclose(shown.wrench[0], want, atol=1e-9)

    def test_a_moment_leaks_into_a_force_of_the_tool(self):
        shown = self.signals([0, 0, 0, 0, 40, 0])  # about the tool's x
        sensors.ForceCrosstalk(None, force=1, moment=0, share=0.5).sense(shown, None)
        np.testing.assert_allclose(shown.wrench[0], [-20, 0, 0, 0, 40, 0], atol=1e-9)


class Steady(InFolder):
    """The machine against NumPy's arm."""

    def setUp(self):
        super().setUp()
        cell.write_model(np.random.default_rng(3), self.folder, True)
        self.robot = descriptions.load(self.folder / "robot.yaml")
        self.payload = self.robot.payload_mass, self.robot.payload_center

    def simulate(self, course, *effects):
        return steady.simulate(self.robot, effects, course, np.random.default_rng(0))

    def loaded(self):
        return LoadTest(POSTURE[None], np.array([[[400.0, -300, 500, 20, 30, -10]]]), np.zeros(1))

    def test_springs_rest_under_weight_and_wrench(self):
        shown = self.simulate(self.loaded())
        load = arm.Frames(self.robot.chain, shown.q_link).load(
            self.robot.chain, self.robot.gravity, self.payload, shown.wrench)
        want = POSTURE + self.robot.column("compliance") * load[0]
        np.testing.assert_allclose(shown.q_link[0], want, atol=1e-9)
        np.testing.assert_allclose(shown.xyz, arm.Frames(self.robot.chain, shown.q_link).tip,
                                   atol=1e-9)

    def test_torques_are_those_of_inverse_dynamics_and_friction(self):
        time = np.arange(800) * 5e-4
        wave = 0.3 * np.sin(4 * time)[:, None] * np.ones(6)
        speed, push = 1.2 * np.cos(4 * time)[:, None] * np.ones(6), -16 * wave
        still = np.zeros((800, 6))
        shown = self.simulate(Motion(time, POSTURE + wave, speed, push, still, np.zeros(800)))
        bodies = arm.lumped(self.robot.chain)
        rows = slice(100, 300, 50)
        bodies[-1] += arm.point_mass(self.robot.chain, *self.payload)
        rigid = arm.regressor(self.robot.chain, self.robot.gravity, shown.q_link[rows], speed[rows],
                              push[rows]) @ bodies.ravel()
        want = rigid + sum(self.robot.column(name) * values for name, values in (
            ("rotor_inertia", push[rows]), ("viscous", speed[rows]), ("coulomb", 1.0)))
        # The engine's payload is a small body, and it sees every eighth row.
        np.testing.assert_allclose(shown.tau[rows], want, rtol=2e-3, atol=1.0)

    def test_a_joint_stands_elsewhere_by_another_ones_load(self):
        law = stand.ZeroByLoad(4, driver=2, shift=1e-7)
        plain, moved = self.simulate(self.loaded()), self.simulate(self.loaded(), law)
        windup = plain.q_link[0, 1] - POSTURE[1]
        want = np.zeros(6)
        want[3] = 1e-7 * windup / self.robot.column("compliance")[1]
        np.testing.assert_allclose(moved.q_link[0] - plain.q_link[0], want, atol=1e-12)
        self.assertGreater(np.linalg.norm(moved.xyz - plain.xyz), 1e-6)


class Draw(InFolder):
    def test_half_are_alone_a_quarter_beside_and_a_quarter_clean(self):
        drawn = cases.draw(4, 40)
        families = [case.family for case in drawn]
        self.assertEqual([families.count(name) for name in ("alone", "beside", "clean")],
                         [20, 10, 10])
        self.assertEqual({case.foreign for case in drawn} - {None}, set(menu.MENU))

    def test_the_same_seed_draws_the_same_cases(self):
        words = "from foreign import cases; print(cases.draw(4, 12))"
        drawn = {subprocess.run([sys.executable, "-c", words], capture_output=True, check=True,
                                env=os.environ | {"PYTHONPATH": str(HERE), "PYTHONHASHSEED": salt}
                                ).stdout for salt in ("1", "2")}
        self.assertEqual(len(drawn), 1)

    def test_a_case_shows_its_law_and_its_floor_does_not(self):
        case = cases.Case("alone", "poses", "bent_rail", None, (2, 3, 0))
        truth = cases.write(case, self.folder / "case", self.folder / "floors")
        self.assertTrue(campaign.ACCEPTED[0] <= truth["foreign"]["over_noise"]
                        <= campaign.ACCEPTED[1])
        law = stand.BentRail(None, **truth["foreign"]["parameters"])
        bent, straight = (recording.read(self.folder / folder / "holdout.csv").groups["xyz"]
                          for folder in ("case", "floors"))
        np.testing.assert_allclose(bent - straight, law.moved(None, straight) - straight,
                                   atol=3 * truth["noise"]["tcp_position"][0])

    def test_every_law_says_where_it_is_right(self):
        scale = mock.MagicMock()
        scale.configure_mock(
            span=np.ones(6), speed=np.ones(6), load=np.ones(6), torque=np.ones(6), force=1.0,
            compliance=np.ones(6), duration=30.0, moment=1.0, q=np.random.default_rng(1).normal(
                size=(50, 6)), place=np.random.default_rng(2).normal(size=(50, 3)),
            torque_unit=lambda joint: 1.0)
        for name, entry in menu.MENU.items():
            joints = entry.joints(scale) if callable(entry.joints) else entry.joints
            law = entry.draw(np.random.default_rng(5), joints[0], scale, 1.0)
            self.assertEqual(law.name, name)
            self.assertTrue(law.places(), name)
            for told in law.laws():
                self.assertIn((told["place"], told.get("joint") or told.get("axis")),
                              law.places())


class Judging(InFolder):
    truth = {"family": "beside", "kind": "torque", "robot": "kr270",
             "foreign": {"effect": "hose", "joint": 5, "exists": True, "undone": False, "kin": [],
                         "over_noise": 9.0, "places": [["joint_torque", 5]]},
             "known": {"effect": "coulomb_friction", "joint": 2}}
    errors = {"nominal": {"holdout": 100.5, "untrained": 0.6},
              "floor": {"holdout": 0.5, "untrained": 0.5},
              "flexcomp": {"holdout": 4.5, "untrained": 0.5}}

    def row(self, *findings, truth=None, errors=None):
        (self.folder / "run.json").write_text(json.dumps(
            {"code": 0, "seconds": 1.0, "cpu": 1.0, "last_words": ""}))
        (self.folder / "errors.json").write_text(json.dumps(
            {"errors": errors or self.errors, "failures": {}}))
        (self.folder / "diagnosis.json").write_text(json.dumps(
            {"verdict": "explained", "findings": list(findings)}))
        return judge.judged("000", truth or self.truth, self.folder)

    law = {"effect": "law", "place": "joint_torque", "joint": 5, "formula": "a*sin(q4)"}
    known = {"effect": "coulomb_friction", "joint": 2}

    def test_the_error_falls_by_its_root(self):
        fell = self.row()["fall"]["flexcomp"]
        self.assertAlmostEqual(fell["holdout"], 1 - 0.2)
        self.assertIsNone(fell["untrained"])

    def test_both_are_found(self):
        found = judge.figures([self.row(self.law, self.known)])
        self.assertEqual(found["both_found"]["count"], 1)
        self.assertEqual(found["wrong_known_name"]["count"], 0)

    def test_a_law_elsewhere_is_not_right(self):
        row = self.row(self.law | {"joint": 4})
        self.assertFalse(row["right_law"])
        self.assertEqual(row["laws"], 1)

    def test_a_name_that_is_not_there_is_wrong(self):
        row = self.row(self.known | {"joint": 3}, {"effect": "torque_ripple", "joint": 5})
        self.assertEqual(row["wrong"], ["coulomb_friction 3", "torque_ripple 5"])

    def test_another_name_for_the_same_is_right(self):
        truth = self.truth | {"known": {"effect": "payload", "joint": None}}
        for effect, joint, right in (("link_mass", 6, True), ("link_mass", 5, False)):
            row = self.row({"effect": effect, "joint": joint}, truth=truth)
            self.assertEqual((row["known_found"], not row["wrong"]), (right, right))

    def test_kin_is_no_wrong_name_at_its_joint(self):
        truth = self.truth | {"foreign": self.truth["foreign"] | {"kin": ["torque_ripple"]}}
        for joint, wrong in ((5, 0), (4, 1)):
            row = self.row({"effect": "torque_ripple", "joint": joint}, truth=truth)
            self.assertEqual(len(row["wrong"]), wrong)

    def test_kin_of_one_form_is_no_other_form(self):
        truth = self.truth | {"foreign": self.truth["foreign"] | {"kin": ["torque_gain/heat"]}}
        for form, wrong in (("heat", 0), ("", 1)):
            row = self.row({"effect": "torque_gain", "joint": 5, "form": form}, truth=truth)
            self.assertEqual(len(row["wrong"]), wrong)

    def test_kin_of_what_begins_must_say_when(self):
        truth = self.truth | {"foreign": self.truth["foreign"] | {"kin": ["joint_offset"], "begins": True,
                                                                  "exists": False}}
        for when, told in ((None, 0), ([{"file": "train.csv", "time": [20, 60]}], 1)):
            row = self.row({"effect": "joint_offset", "joint": 5, "when": when}, truth=truth)
            self.assertEqual(len(row["wrong"]), 1 - told)
            self.assertEqual(judge.figures([row])["no_law_and_told"]["count"], told)

    def test_a_law_on_a_clean_machine_is_counted(self):
        truth = self.truth | {"family": "clean", "foreign": None, "known": None}
        found = judge.figures([self.row(self.law, truth=truth)])
        self.assertEqual(found["laws_on_clean"]["count"], 1)

    def test_without_an_updated_model_nothing_fell(self):
        errors = {name: value for name, value in self.errors.items() if name != "flexcomp"}
        found = judge.figures([self.row(errors=errors)])
        self.assertEqual(found["fall"]["holdout"]["flexcomp"]["reached"]["count"], 0)

    def test_a_model_that_leaves_more_is_worse(self):
        for left, worse in ((0.9, []), (60.0, ["untrained"])):
            errors = self.errors | {"flexcomp": {"holdout": 4.5, "untrained": left}}
            self.assertEqual(self.row(errors=errors)["worse"]["flexcomp"], worse)

    def test_excess_is_nothing_for_noise(self):
        left = np.random.default_rng(1).normal(size=(5000, 3)) * [1, 2, 3]
        usable = {"tcp_position": np.ones((5000, 3), bool)}
        noise = {"tcp_position": [1, 2, 3]}
        self.assertAlmostEqual(trial.excess({"tcp_position": left}, usable, noise), 0, delta=0.1)
        left[:, 1] += 10
        self.assertAlmostEqual(trial.excess({"tcp_position": left}, usable, noise), 25, delta=0.5)


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
    text = {"verdict": "explained", "findings": [], "shown": shown}
    (out / "diagnosis.json").write_text(json.dumps(text))
"""


class Command(InFolder):
    def test_a_campaign_runs_from_its_seed_to_its_summary_and_again(self):
        tool = self.folder / "tool"
        tool.write_text(CHEAT)
        tool.chmod(0o755)
        drawn = [cases.Case("alone", "poses", "soft_floor", None, (5, 3, 0))]
        first, second = self.folder / "first", self.folder / "second"
        words = ["--seed", "5", "--cases", "1", "--jobs", "1", "--tool", str(tool), "--out"]
        with (mock.patch.object(cases, "draw", lambda *_: drawn), mock.patch("sys.stdout"),
              mock.patch("sys.stderr")):
            self.assertEqual(command.main([*words, str(first)]), 0)
            self.assertEqual(command.main([*words, str(second), "--again", str(first),
                                           "--no-rivals"]), 0)
        for out in (first, second):
            rows = json.loads((out / "summary.json").read_text())["cases"]
            self.assertEqual([row["foreign"] for row in rows], ["soft_floor"])
            self.assertEqual("refit" in rows[0]["excess"], out == first)
            answer = json.loads((out / "answers/000/diagnosis.json").read_text())
            self.assertEqual(answer["shown"], ["holdout.csv", "model", "out", "train.csv"])


if __name__ == "__main__":
    unittest.main()
