"""Laws written as formulas: obeyed as numpy computes them, found in recordings that numpy made."""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import scipy.signal
import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "campaigns" / "diagnosis"))

from generator import dynamics, kinematics, robot as robots  # noqa: E402

PROGRAM = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"
SHIPPED = pathlib.Path(os.environ["FLEXCOMP_SOURCE"]) / "host/robots/kr270"
PERIOD = 0.005  # s
TORQUE_NOISE = 0.5  # N·m
POSITION_NOISE = 1e-5  # m


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)


def run_well(*arguments):
    done = run(*arguments)
    assert done.returncode == 0, done.stderr
    return done.stdout


class Swing:
    """A stiff KR 270 that swings all joints, a force on its tool; and its signals by numpy."""

    def __init__(self, rows=2000):
        self.robot = robots.load(SHIPPED / "robot.yaml")
        self.robot.gravity = np.array([0, 0, -9.81])
        self.t = PERIOD * np.arange(rows)
        pace, phase = 1 + 0.37 * np.arange(6), np.arange(6)
        turn = np.outer(self.t, pace) + phase
        self.q = np.array([0.1, -1.2, 1.4, 0.2, 0.5, 0.1]) + 0.4 * np.sin(turn)
        self.v = 0.4 * pace * np.cos(turn)
        self.a = -0.4 * pace**2 * np.sin(turn)
        self.wrench = np.stack([300 * np.cos(2 * self.t), 150 * np.sin(3 * self.t), -400 + 0 * self.t,
                                5 + 0 * self.t, 3 * np.sin(self.t), 0 * self.t], 1)
        self.place = kinematics.posture(self.robot, self.q)
        self.jacobian = kinematics.jacobian(self.place)
        self.tau = (dynamics.inverse_dynamics(self.robot, self.q, self.v, self.a)
                    - np.einsum("nij,ni->nj", self.jacobian, self.wrench))

    def write(self, file, tau=None, position=None, temperature=False):
        names = ["t"] + [f"q_meas_{j}" for j in range(1, 7)] + ["fx", "fy", "fz", "mx", "my", "mz"]
        columns = [self.t[:, None], self.q, self.wrench]
        if tau is not None:
            names += [f"tau_{j}" for j in range(1, 7)]
            columns.append(tau)
        if position is not None:
            names += ["x", "y", "z"]
            columns.append(position)
        if temperature:
            names.append("temp_c")
            columns.append(20 + self.t[:, None])
        np.savetxt(file, np.hstack(columns), "%.15g", ",", header=",".join(names), comments="")


def read(file, columns):
    with open(file, newline="") as stream:
        rows = list(csv.DictReader(stream))
    return np.array([[float(row[name]) for name in columns] for row in rows])


TORQUES = [f"tau_{j}" for j in range(1, 7)]


class WithAFolder(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def model(self, effects=(), compliance=0.0, name="robot.yaml"):
        """A stiff KR 270 with weight, and effects."""
        text = yaml.safe_load((SHIPPED / "robot.yaml").read_text())
        text.update(urdf=str(SHIPPED / "kr270.urdf"), gravity=[0, 0, -9.81], effects=list(effects))
        if compliance is not None:
            text["joints"] = {joint: {"compliance": compliance} for joint in text["joints"]}
        (self.folder / name).write_text(yaml.safe_dump(text))
        return self.folder / name

    def law_file(self, **law):
        (self.folder / "law.yaml").write_text(yaml.safe_dump(law))
        return self.folder / "law.yaml"


class Simulation(WithAFolder):
    """The difference that a law makes is what numpy says it is."""

    @classmethod
    def setUpClass(cls):
        cls.swing = Swing()

    def change(self, law, columns):
        law = {"effect": "law", **law}
        recording = self.folder / "recording.csv"
        still = np.zeros((len(self.swing.t), 6))
        self.swing.write(recording, still, still[:, :3], temperature=True)
        made = []
        for effects in ([], [law]):
            out = self.folder / "out.csv"
            run_well("simulate", "--model", self.model(effects), "--recording", recording, "--out", out)
            made.append(read(out, columns))
        return (made[1] - made[0])[20:-20]  # where the angles are differentiated from both sides

    def expect(self, wanted, found, share=1e-5):
        wanted = wanted[20:-20]
        self.assertGreater(np.abs(wanted).max(), 0)
        self.assertLess(np.abs(found - wanted).max(), share * np.abs(wanted).max())

    def test_a_torque_follows_angle_speed_and_torque(self):
        s = self.swing
        found = self.change({"place": "joint_torque", "joint": 5, "a": 40, "b": 0.2,
                             "formula": "a*sin(q4) + b*v5*abs(tau5)"}, TORQUES)
        wanted = np.zeros((len(s.t), 6))
        wanted[:, 4] = 40 * np.sin(s.q[:, 3]) + 0.2 * s.v[:, 4] * np.abs(s.tau[:, 4])
        self.expect(wanted, found)

    def test_a_joint_stands_off_by_an_angle(self):
        s = self.swing
        found = self.change({"place": "joint_angle", "joint": 2, "a": 1e-4,
                             "formula": "a*max(0, fx/(100*F))^2", "F": 1, "units": {"F": "N"}}, "xyz")
        angle = 1e-4 * np.maximum(0, s.wrench[:, 0] / 100) ** 2
        self.expect(angle[:, None] * s.jacobian[:, :3, 1], found)

    def test_a_wind_up_follows_the_load_at_rest(self):
        s = self.swing
        load = (np.einsum("nij,ni->nj", s.jacobian, s.wrench)
                - dynamics.inverse_dynamics(s.robot, s.q, 0 * s.v, 0 * s.a))
        for signal, sign in (("load3", 1), ("tau3", -1)):
            found = self.change({"place": "joint_windup", "joint": 3, "a": 1e-7, "b": 2000,
                                 "formula": f"a*b*tanh({signal}/b)"}, "xyz")
            angle = sign * 1e-7 * 2000 * np.tanh(load[:, 2] / 2000)
            self.expect(angle[:, None] * s.jacobian[:, :3, 2], found)

    def test_the_tcp_moves_along_the_tool(self):
        s = self.swing
        found = self.change({"place": "tcp_tool", "axis": "z", "a": 1e-4, "formula": "a*t*step(a3)*temp_c",
                             "units": {"a": "m/(s*K)"}}, "xyz")
        size = 1e-4 * s.t * (s.a[:, 2] > 0) * (20 + s.t)
        self.expect(size[:, None] * s.place.tool_rotation[:, :, 2], found)

    def test_the_base_turns(self):
        s = self.swing
        found = self.change({"place": "base", "axis": "ry", "a": 1e-6, "formula": "a*(x*fz - z*fx)"}, "xyz")
        moment = s.place.tcp[:, 0] * s.wrench[:, 2] - s.place.tcp[:, 2] * s.wrench[:, 0]
        axis = np.broadcast_to([0.0, 1.0, 0.0], (len(s.t), 3))
        self.expect(1e-6 * moment[:, None] * np.cross(axis, s.place.tcp), found)

    def test_a_force_sensor_that_shows_more_leaves_less_for_the_drives(self):
        s = self.swing
        found = self.change({"place": "sensor fz", "a": 0.1, "formula": "a*abs(fx)"}, TORQUES)
        less = np.zeros((len(s.t), 6))
        less[:, :3] = -0.1 * np.abs(s.wrench[:, :1]) * s.place.tool_rotation[:, :, 2]
        self.expect(-np.einsum("nij,ni->nj", s.jacobian, less), found)

    def test_a_force_is_known_along_the_tool_too(self):
        s = self.swing
        found = self.change({"place": "joint_torque", "joint": 4, "a": 0.1, "b": 2,
                             "formula": "a*fx_tool + b*mz_tool", "units": {"a": "m"}}, TORQUES)
        force, moment = (np.einsum("nij,ni->nj", s.place.tool_rotation, half)
                         for half in (s.wrench[:, :3], s.wrench[:, 3:]))
        wanted = np.zeros((len(s.t), 6))
        wanted[:, 3] = 0.1 * force[:, 0] + 2 * moment[:, 2]
        self.expect(wanted, found)

    def test_lag_is_that_of_scipy(self):
        s = self.swing
        found = self.change({"place": "sensor x", "a": 1e-6, "T": 0.4, "formula": "a*lag(fx, T)"}, "xyz")
        _, lagging, _ = scipy.signal.lsim(([1], [0.4, 1]), s.wrench[:, 0] - s.wrench[0, 0], s.t)
        wanted = np.zeros((len(s.t), 3))
        wanted[:, 0] = 1e-6 * (lagging + s.wrench[0, 0])
        self.expect(wanted, found)

    def test_a_path_is_driven_with_play_as_a_recording_shows_it(self):
        s = self.swing
        law = {"place": "tcp_base", "axis": "y", "a": 1e-6, "gap": 200, "formula": "a*play(fx, gap)"}
        wanted = self.change(law, "xyz")
        path = self.folder / "path.csv"
        s.write(path)
        path.write_text(path.read_text().replace("q_meas_", "q_cmd_"))
        shown = []
        for effects in ([], [{"effect": "law", **law}]):
            out = self.folder / "driven.csv"
            run_well("simulate", "--model", self.model(effects), "--path", path, "--out", out)
            shown.append(read(out, "xyz"))
        self.assertGreater(np.abs(wanted).max(), 0)
        self.assertLess(np.abs((shown[1] - shown[0])[20:-20] - wanted).max(), 1e-9)

    def test_play_remembers(self):
        s = self.swing
        found = self.change({"place": "tcp_base", "axis": "y", "a": 1e-6, "gap": 200,
                             "formula": "a*play(fx, gap)"}, "xyz")
        held, follows = s.wrench[0, 0], []
        for force in s.wrench[:, 0]:
            held = np.clip(held, force - 100, force + 100)
            follows.append(held)
        wanted = np.zeros((len(s.t), 3))
        wanted[:, 1] = 1e-6 * np.array(follows)
        self.expect(wanted, found)


class Refusals(WithAFolder):
    def refused(self, law, *arguments):
        model = self.model([{"effect": "law", **law}])
        recording = self.folder / "recording.csv"
        Swing(100).write(recording, position=np.zeros((100, 3)))
        done = run("simulate", "--model", model, "--recording", recording, "--out", self.folder / "out.csv")
        self.assertEqual(2, done.returncode)
        self.assertEqual(1, done.stderr.count("\n"))
        self.assertFalse((self.folder / "out.csv").exists())
        self.assertRegex(done.stderr, r"robot\.yaml:\d+: 'effects\[0\]\.")
        return done.stderr

    def test_file_line_and_key_of_an_effect_without_its_form_are_named(self):
        model = self.model([{"effect": "backlash", "joint": 2, "gap": 1e-4}])
        line = 1 + next(i for i, text in enumerate(model.read_text().splitlines()) if "effect: backlash" in text)
        recording = self.folder / "recording.csv"
        Swing(100).write(recording, position=np.zeros((100, 3)))
        done = run("simulate", "--model", model, "--recording", recording, "--out", self.folder / "out.csv")
        self.assertEqual(2, done.returncode)
        self.assertRegex(done.stderr, rf"robot\.yaml:{line}: 'effects\[0\]\.effect': backlash needs a form; expected one of")

    def test_file_line_key_and_column_are_named(self):
        torque = {"place": "joint_torque", "joint": 5}
        self.assertRegex(self.refused({**torque, "formula": "a*v5 + b*v9", "a": 1, "b": 2}),
                         r"formula': column 10: 'v9' is neither a parameter .* expected one of: q1\.\.q6")
        self.assertRegex(self.refused({**torque, "formula": "a*(v5", "a": 1}), "column 6: expected a closing")
        self.assertRegex(self.refused({**torque, "formula": "sin(v5)*a", "a": 1}), "column 5: 'v5' is in 1/s")
        self.assertRegex(self.refused({**torque, "formula": "a*v5", "a": 1, "units": {"a": "N·m"}}),
                         "column 1: it is in N·m/s; joint_torque needs N·m")
        self.assertRegex(self.refused({**torque, "formula": "a*v5", "a": 1, "units": {"a": "Nm"}}),
                         "units': a: 'Nm': 'Nm' is no SI unit")
        self.assertRegex(self.refused({**torque, "formula": "a*v5", "a": 1, "c": 1}), "'c' is not in the formula")
        self.assertRegex(self.refused({**torque, "formula": "a*q4", "a": 1, "q4": 1}), "'q4' is a signal")
        self.assertRegex(self.refused({"place": "joint_torque", "formula": "a*v5", "a": 1}),
                         "place': joint_torque needs a joint")
        self.assertRegex(self.refused({"place": "tcp_base", "axis": "w", "formula": "a", "a": 1}),
                         "place': tcp_base needs axis: x, y or z")

    def test_a_formula_without_a_value_is_told_with_time_and_signals(self):
        told = self.refused({"place": "tcp_base", "axis": "x", "formula": "a/(q1 - q1)", "a": 1})
        self.assertRegex(told, r"has no value for .*recording\.csv at t = 0 s, where a = 1, q1 = ")

    def test_a_law_by_temperature_needs_one(self):
        model = self.model([{"effect": "law", "place": "tcp_base", "axis": "x", "formula": "a*temp_c", "a": 1}])
        recording = self.folder / "recording.csv"
        Swing(100).write(recording, position=np.zeros((100, 3)))
        done = run("simulate", "--model", model, "--recording", recording, "--out", self.folder / "out.csv")
        self.assertEqual(2, done.returncode)
        self.assertIn("has no temp_c", done.stderr)


class Diagnosis(WithAFolder):
    """Recordings made by numpy alone."""

    @classmethod
    def setUpClass(cls):
        cls.swing = Swing()

    def diagnose(self, tau, law, model=None):
        recording, out = self.folder / "recording.csv", self.folder / "diagnosis"
        noise = np.random.default_rng(7).normal(0, TORQUE_NOISE, tau.shape)
        self.swing.write(recording, tau + noise)
        words = ["--law", self.law_file(**law)] if law else []
        printed = run_well("diagnose", "--model", model or self.model(), "--recording", recording, *words,
                           "--out", out)
        return json.loads((out / "diagnosis.json").read_text()), printed

    def with_law(self):
        s = self.swing
        tau = s.tau.copy()
        tau[:, 4] += 40 * np.sin(s.q[:, 3]) + 0.2 * s.v[:, 4] * np.abs(s.tau[:, 4])
        return tau

    TRUE = {"place": "joint_torque", "joint": 5, "formula": "a*sin(q4) + b*v5*abs(tau5)",
            "ranges": {"a": [-200, 200], "b": [0, 5]}, "units": {"a": "N·m"}}

    def test_a_true_law_stands_with_its_parameters_and_goes_into_the_model(self):
        found, printed = self.diagnose(self.with_law(), self.TRUE)
        self.assertEqual("explained", found["verdict"])
        finding = found["findings"][0]
        self.assertEqual(("law", 5, "joint_torque", self.TRUE["formula"]),
                         tuple(finding[key] for key in ("effect", "joint", "place", "formula")))
        for name, true, unit in (("a", 40, "N·m"), ("b", 0.2, "s")):
            parameter = finding["parameters"][name]
            self.assertLess(abs(parameter["value"] - true), 5 * parameter["std"])
            self.assertLess(parameter["std"], 0.01 * true)
            self.assertEqual(unit, parameter["unit"])
        self.assertIn("follows the angle of joint 4", finding["statement"])
        self.assertTrue(found["laws"][0]["stands"])
        self.assertIn("it stands", printed)
        self.assertIn("law of joint 5: a*sin(q4)", (self.folder / "diagnosis/report.html").read_text())
        again, _ = self.diagnose(self.with_law(), None, self.folder / "diagnosis/updated_model.yaml")
        self.assertEqual(("no_mismatch", []), (again["verdict"], again["findings"]))

    def test_a_law_of_the_model_is_corrected(self):
        known = {"effect": "law", "place": "joint_torque", "joint": 5, "formula": self.TRUE["formula"],
                 "a": 25, "b": 0.2}
        ranges = {"ranges": {"a": [-200, 200], "b": [-5, 5]}}
        self.diagnose(self.with_law(), {**self.TRUE, **ranges}, self.model([known]))
        updated = yaml.safe_load((self.folder / "diagnosis/updated_model.yaml").read_text())
        self.assertEqual(1, len(updated["effects"]))
        self.assertAlmostEqual(40, updated["effects"][0]["a"], delta=0.4)

    def test_a_shape_is_found_within_its_ranges(self):
        s = self.swing
        tau = s.tau.copy()
        tau[:, 1] += 60 * np.tanh((s.q[:, 4] - 0.35) / 0.08)
        found, _ = self.diagnose(tau, {"place": "joint_torque", "joint": 2, "formula": "a*tanh((q5 - c)/w)",
                                       "ranges": {"a": [-500, 500], "c": [-1, 2], "w": [0.01, 1]}})
        finding = found["findings"][0]
        self.assertEqual(("law", 2), (finding["effect"], finding["joint"]))
        for name, true in (("a", 60), ("c", 0.35), ("w", 0.08)):
            self.assertAlmostEqual(true, finding["parameters"][name]["value"], delta=0.02 * true)

    def test_a_wrong_law_is_refused_and_why_is_said(self):
        wrong = {"place": "joint_torque", "joint": 5, "formula": "a*cos(3*q6)", "ranges": {"a": [-200, 200]}}
        found, printed = self.diagnose(self.with_law(), wrong)
        # The one that is true may be composed.
        self.assertNotIn(wrong["formula"], [finding.get("formula") for finding in found["findings"]])
        self.assertFalse(found["laws"][0]["stands"])
        self.assertTrue(found["laws"][0]["why_not"])
        self.assertIn("it does not stand, since", printed)

    def test_an_effect_of_the_catalogue_keeps_its_name(self):
        tau = self.swing.tau.copy()
        tau[:, 3] += 30 * self.swing.v[:, 3]
        found, printed = self.diagnose(
            tau, {"place": "joint_torque", "joint": 4, "formula": "c*v4", "ranges": {"c": [0, 200]}})
        self.assertEqual([("viscous_friction", 4)],
                         [(finding["effect"], finding["joint"]) for finding in found["findings"]])
        self.assertIn("what it does is known by name: viscous friction of joint 4", printed)

    def test_nothing_concealed_no_law(self):
        found, _ = self.diagnose(self.swing.tau, self.TRUE)
        self.assertEqual("no_mismatch", found["verdict"])
        self.assertFalse(found["laws"][0]["stands"])

    def test_a_law_that_cannot_be_sought_is_refused_in_one_line(self):
        for law, why in (({"ranges": {"a": [1, 2]}, "formula": "a*q4"}, "a acts in proportion"),
                         ({"ranges": {"a": [2, 1]}, "formula": "a*q4"}, "expected a lower and a higher bound"),
                         ({"ranges": {"a": [-2, 1]}, "formula": "a*b*q4"}, "column 3: 'b' is neither"),
                         ({"formula": "q4"}, "has no parameter to be sought"),
                         ({"ranges": {"a": [-2, 1]}, "formula": "a*temp_c"}, "follows temp_c, which")):
            recording = self.folder / "recording.csv"
            self.swing.write(recording, self.swing.tau)
            done = run("diagnose", "--model", self.model(), "--recording", recording, "--out",
                       self.folder / "diagnosis", "--law",
                       self.law_file(place="joint_angle", joint=2, **law))
            self.assertEqual((2, 1), (done.returncode, done.stderr.count("\n")), done.stderr)
            self.assertRegex(done.stderr, r"law\.yaml:\d+: '")
            self.assertIn(why, done.stderr)


class Corrections(WithAFolder):
    """Programs and the plant with a law: a command undoes its motion."""

    LAW = {"effect": "law", "place": "tcp_tool", "axis": "z", "formula": "a*sin(3*q1) + b*abs(v2)",
           "a": 3e-4, "b": 2e-4}

    def path(self):
        swing = Swing(400)
        names = ["t"] + [f"q_cmd_{j}" for j in range(1, 7)] + ["fx", "fy", "fz", "mx", "my", "mz"]
        file = self.folder / "path.csv"
        np.savetxt(file, np.hstack([swing.t[:, None], swing.q, swing.wrench]), "%.15g", ",",
                   header=",".join(names), comments="")
        return file

    def test_compensate_corrects_a_program_for_a_law(self):
        path, table, out = self.path(), self.folder / "t.fct", self.folder / "out.csv"
        model = self.model([self.LAW], compliance=None)
        run_well("table", "--model", model, "--path", path, "--tolerance", "1e-6", "--out", table)
        told = json.loads(run_well("compensate", "--model", model, "--table", table, "--path", path, "--out", out,
                                   "--json"))
        self.assertGreater(told["learned"]["before"], 2e-4)
        self.assertLess(told["learned"]["after"], 0.1 * told["learned"]["before"])

    def contour(self):
        """A closed path in the air: its wrench is nothing."""
        turn = np.linspace(0, 2 * np.pi, 200)
        q = np.array([0.1, -1.2, 1.4, 0.2, 0.5, 0.1]) + 0.05 * np.stack(
            [np.sin(turn), np.cos(turn), np.sin(turn + 1), 0 * turn, np.cos(turn), 0 * turn], 1)
        names = ["t"] + [f"q_cmd_{j}" for j in range(1, 7)] + ["fx", "fy", "fz", "mx", "my", "mz"]
        file = self.folder / "contour.csv"
        np.savetxt(file, np.hstack([turn[:, None], q, np.zeros((200, 6))]), "%.15g", ",",
                   header=",".join(names), comments="")
        return file

    def milled(self, effects, path):
        model, out = self.model(effects, compliance=None), self.folder / "run.csv"
        table = self.folder / "t.fct"
        run_well("table", "--model", model, "--path", path, "--tolerance", "1e-6", "--out", table)
        run_well("plant", "--model", model, "--path", path, "--table", table, "--out", out,
                 "--without-compensation", "--force-noise", 0, "--moment-noise", 0)
        return read(out, [f"q_meas_{j}" for j in range(1, 7)]), read(out, "xyz")

    def test_the_plant_is_moved_by_a_law(self):
        path = self.contour()
        _, plain = self.milled([], path)
        q, moved = self.milled([self.LAW], path)
        place = kinematics.posture(robots.load(SHIPPED / "robot.yaml"), q)
        speed = np.diff(q[:, 1]) / 0.004  # of one period of the plant
        size = 3e-4 * np.sin(3 * q[1:, 0]) + 2e-4 * np.abs(speed)
        wanted = size[:, None] * place.tool_rotation[1:, :, 2]
        self.assertLess(np.abs(moved[1:] - plain[1:] - wanted).max(), 0.01 * np.abs(wanted).max())

    def test_the_plant_has_no_temperature(self):
        path = self.contour()
        law = {"effect": "law", "place": "tcp_base", "axis": "x", "formula": "a*temp_c", "a": 1e-5}
        with self.assertRaisesRegex(AssertionError, "follows temp_c, and the plant has no temperature"):
            self.milled([law], path)


if __name__ == "__main__":
    unittest.main()
