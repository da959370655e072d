"""The command around the readers of published recordings, and the comparison with rivals."""

import json
import os
import pathlib
import shutil
import subprocess
import sys
import unittest

import numpy as np
import scipy.io

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from machines import study, synthetic, tables  # noqa: E402
from machines.registry import MACHINES  # noqa: E402
from machines.rivals import comparison  # noqa: E402
from machines.scratch import Scratch  # noqa: E402


class Figures(unittest.TestCase):
    def test_errors_are_measured_where_both_are_known(self):
        errors, signal = np.array([[3.0], [np.nan], [4.0]]), np.array([[30.0], [1000.0], [40.0]])
        self.assertAlmostEqual(0.1, study.relative(errors, signal))

    def test_an_answer_against_the_contract_is_refused(self):
        for text in ("no JSON", "{}",
                     '{"verdict": "explained", "findings": [{}], "unexplained": null}'):
            with self.assertRaises(study.NoAnswer):
                study.parse(text)


class Command(Scratch):
    def setUp(self):
        super().setUp()
        self.tool = self.folder / "flexcomp"
        self.tool.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{HERE / "fake_tool.py"}" "$@"\n')
        self.tool.chmod(0o755)
        self.data = self.folder / "data"
        self.data.mkdir()

    def run_command(self, *words, answer="silent", findings=(), data=True):
        environment = {name: value for name, value in os.environ.items()
                       if name != "FLEXCOMP_MACHINE_DATA"}
        environment |= {"PYTHONPATH": str(HERE.parent), "FAKE_ANSWER": answer,
                        "FAKE_FINDINGS": json.dumps(findings)}
        words = [*words, "--tool", self.tool, "--out", self.folder / "out"]
        words += ["--data", self.data] if data else []
        return subprocess.run([sys.executable, "-m", "machines", *map(str, words)],
                              capture_output=True, text=True, env=environment)

    def make(self, *names):
        for name in names:
            getattr(synthetic, name)(self.data / MACHINES[name].reader.FOLDER)

    def assert_refused(self, done, saying):
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertIn(saying, done.stderr.splitlines()[-1])
        self.assertNotIn("Traceback", done.stderr)

    def test_absent_data_are_skipped_saying_so(self):
        done = self.run_command()
        self.assertEqual((0, ""), (done.returncode, done.stderr))
        self.assertEqual(list(MACHINES), [line.split(":")[0] for line in done.stdout.splitlines()])
        self.assertEqual(len(MACHINES), done.stdout.count("skipped, its data are not there"))

    def test_every_machine_is_read_diagnosed_and_judged(self):
        self.make(*MACHINES)
        done = self.run_command()
        self.assertEqual((1, ""), (done.returncode, done.stderr))
        for name in MACHINES:
            self.assertIn(f"{name}: ", done.stdout)
        self.assertNotIn("holds: ", done.stdout)

    def test_goals_hold_where_the_answer_is_right(self):
        self.make("friction_damper", "ur5")
        loop = ("friction_hysteresis", 1, {"torque": 1.5e4, "slip": 2e-3, "gap": 4e-3})
        done = self.run_command("friction_damper", answer="perfect", findings=[loop])
        self.assertEqual((0, ""), (done.returncode, done.stderr), done.stdout)
        self.assertIn("gap 0.004 ± 0.01", done.stdout)
        sag = ("joint_stiffness", 2, {"compliance": 3e-5})
        done = self.run_command("ur5", answer="perfect", findings=[("base_frame", None, {}), sag])
        self.assertEqual(0, done.returncode, done.stdout)
        done = self.run_command("ur5", answer="perfect", findings=[sag, ("base_frame", None, {})])
        self.assertEqual(1, done.returncode, done.stdout)
        self.assertIn("MISSED: geometry is named first", done.stdout)

    def test_a_damaged_file_gives_one_line(self):
        damages = {
            "friction_damper": ("0.5Hz36lbtension1amplitude.csv", "\n0.5,", "\n0.5x,",
                                "is no number"),
            "emps": ("DATA_EMPS.csv", "vir_V", "voltage", "no column 'vir_V'"),
            "ur5": ("3D_UR5_uncalibrated_grid_cleaned.csv", "\n7,", "\n7,1,",
                    "cells under a header"),
            "kuka_kr300": ("kr300_B.csv", "\n0.008,", "\n0.004,", "does not grow"),
            "franka_panda": ("panda_exciting_1kHz.csv", "tau_Nm_7", "tau", "no column 'tau_Nm_7'"),
            "staubli_tx40": ("tx40_mdh_modified.urdf", "</robot>", "", "no robot description"),
            "hilti_jaibot": ("trailblazer.urdf", "</robot>", "", "no robot description"),
            "unisa_ur10": ("ur10_exciting_trajectory.csv", "tau_6", "tau", "no column 'tau_6'"),
            "unisa_panda": ("panda_exciting_trajectory.csv", "\n0.03", "\n-0.03", "does not grow"),
            "pal_tiago": ("tiago_effort.csv", "arm_4_joint", "arm_joint", "no column '- arm_4_joint_effort'"),
        }
        for name, (file, before, after, saying) in damages.items():
            with self.subTest(name):
                self.make(name)
                path = self.data / MACHINES[name].reader.FOLDER / file
                path.write_text(path.read_text().replace("\r\n", "\n").replace(before, after, 1))
                done = self.run_command(name)
                self.assert_refused(done, saying)
                self.assertEqual(1, done.stderr.count("\n"), done.stderr)
                self.assertIn(file, done.stderr)

    def test_damaged_poses_give_one_line(self):
        self.make("hilti_jaibot")
        path = self.data / "hilti_jaibot" / "flat.yaml"
        renamed = path.read_text().replace("prism_position", "prism")
        for text, saying in ((renamed, "'prism_position'"), ("a: [1, 2\nb: 3\n", "flat.yaml:2"),
                             ("column_heights: {}", "poses at 3.87 m")):
            path.write_text(text)
            done = self.run_command("hilti_jaibot")
            self.assert_refused(done, saying)
            self.assertEqual(1, done.stderr.count("\n"), done.stderr)

    def test_damaged_tables_of_matlab_give_one_line(self):
        self.make("motoman_ma1400")
        path = self.data / "motoman_ma1400" / "leica_left_hand_6x6x6_dataset.mat"
        table = scipy.io.loadmat(path)["dataset"]
        whole = path.read_bytes()
        for damage, saying in ((lambda: path.write_bytes(whole[:300]), "no table 'dataset'"),
                               (lambda: path.write_bytes(b""), "no table 'dataset'"),
                               (lambda: path.write_text("dataset\n1,2\n"), "no table 'dataset'"),
                               (lambda: scipy.io.savemat(path, {"data": table}), "no table 'dataset'"),
                               (lambda: scipy.io.savemat(path, {"dataset": table[:, 1:]}), "found 48 by 25"),
                               (lambda: scipy.io.savemat(path, {"dataset": table[:9]}), "4 poses that were seen")):
            damage()
            done = self.run_command("motoman_ma1400")
            self.assert_refused(done, saying)
            self.assertEqual(1, done.stderr.count("\n"), done.stderr)

    def test_an_arm_that_its_description_has_not_is_told(self):
        for before, after, saying in (("arm_6_link", "arm_six", "no robot description"),
                                      ('<axis xyz="0 0 1"/>', '<axis xyz="0 1 0"/>', "its z axis"),
                                      ('<mass value="2"/>', "", "no robot description")):
            self.make("pal_tiago")
            path = self.data / "pal_tiago" / "tiago_48_schunk.urdf"
            path.write_text(path.read_text().replace(before, after, 1))
            done = self.run_command("pal_tiago")
            self.assert_refused(done, saying)
            self.assertEqual(1, done.stderr.count("\n"), done.stderr)

    def test_answers_that_are_there_are_kept(self):
        self.make("unisa_panda")
        first = self.run_command("unisa_panda", answer="perfect")
        self.assertEqual(first.stdout, self.run_command("unisa_panda", "--keep", answer="absent").stdout)
        self.assertEqual(1, self.run_command("unisa_panda", answer="absent").returncode)

    def test_a_tool_without_an_answer_reaches_nothing(self):
        self.make("friction_damper")
        for answer, saying in (("absent", "an internal fault"), ("broken", "diagnosis.json")):
            done = self.run_command("friction_damper", answer=answer)
            self.assertEqual(1, done.returncode)
            self.assertIn(saying, done.stderr)
            self.assertEqual(1, done.stderr.count("\n"), done.stderr)

    @unittest.skipUnless(shutil.which("gnuplot"), "gnuplot is not there")
    def test_every_machine_has_pictures(self):
        self.make(*MACHINES)
        done = self.run_command("--pictures")
        self.assertEqual((1, ""), (done.returncode, done.stderr))
        for name in MACHINES:
            self.assertTrue(list((self.folder / "out" / name).glob("*.png")), name)

    def test_bad_arguments_are_refused(self):
        self.assert_refused(self.run_command("kuka"), "'kuka' is no machine")
        self.assert_refused(self.run_command(data=False), "FLEXCOMP_MACHINE_DATA")
        self.data.rmdir()
        self.assert_refused(self.run_command(), "is no folder")


class Rivals(Scratch):
    """The comparison around rivals, with a stand-in that predicts 1 N·m too much, or fails."""

    STAND_IN = """import csv, json, pathlib, sys
words = sys.argv[1:]
if "mujoco_sysid" in words:
    sys.exit("a reason")
rows = list(csv.reader(pathlib.Path(words[words.index("--holdout") + 1]).read_text().splitlines()))
torque = [place for place, name in enumerate(rows[0]) if name.startswith("tau")]
with pathlib.Path(words[words.index("--out") + 1]).open("w", newline="") as file:
    writer = csv.writer(file)
    writer.writerow(["t"] + [rows[0][place] for place in torque])
    writer.writerows([row[0], *(float(row[place]) + 1 for place in torque)] for row in rows[1:])
print(json.dumps({"seconds": 2.5, "missing": "a | line"}))
"""

    def setUp(self):
        super().setUp()
        program = self.folder / "rivals"
        (self.folder / "stand_in.py").write_text(self.STAND_IN)
        program.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{self.folder}/stand_in.py" "$@"\n')
        program.chmod(0o755)
        before = os.environ.get(comparison.PYTHON)
        os.environ[comparison.PYTHON] = str(program)
        self.addCleanup(lambda: os.environ.pop(comparison.PYTHON) if before is None
                        else os.environ.__setitem__(comparison.PYTHON, before))

    def outcome(self):
        (experiment,), _ = self.written("unisa_ur10")
        measured = tables.read_recording(experiment.holdout)
        known = {name: values for name, values in measured.items() if name[0] in "t"}
        half = {name: values / 2 if name != "t" else values for name, values in known.items()}
        blind = {name: np.where(measured["t"] > 3.5, np.nan, values) if name != "t" else values
                 for name, values in known.items()}
        answer = study.Answer("explained", [study.Finding("coulomb_friction", 2, {}, "")], "", [])
        return study.Outcome(experiment, answer, experiment.model, measured, half, blind)

    def test_all_are_judged_by_the_same_rows_and_a_failure_is_told(self):
        results = comparison.compare(self.outcome(), self.folder, lambda text: None)
        torques = np.arange(1.0, 7.0)
        errors = [study.rms(torques / 2), 0.0, 1.0, 1.0, None]
        self.assertEqual(["as modelled", "flexcomp", *comparison.RIVALS.values()],
                         [result.method for result in results])
        for wanted, result in zip(errors, results):
            self.assertEqual(wanted is None, result.error is None)
            self.assertAlmostEqual(wanted or 0, result.error or 0, 9)
        self.assertEqual("coulomb_friction of joint 2", results[1].missing)
        self.assertEqual("failed: a reason", results[-1].missing)

    def test_rows_away_from_the_ends_count_where_flexcomp_says_something(self):
        outcome = self.outcome()
        time = outcome.measured["t"]
        chosen = time[comparison._judged(outcome.measured, outcome.after)]
        self.assertAlmostEqual(time[0] + comparison.EDGE, chosen[0], delta=0.009)
        self.assertAlmostEqual(3.5, chosen[-1], delta=0.009)

    def test_the_table_keeps_what_was_not_run(self):
        page = self.folder / "README.md"
        page.write_text("\n".join(["before", comparison.BEGIN, *comparison.HEADER, "| a | old |",
                                   "| b | old |", comparison.END, "after"]))
        comparison.update_page({"b": ["| b | new |", "| b | newer |"], "c": ["| c | new |"]}, page)
        self.assertEqual(["before", comparison.BEGIN, *comparison.HEADER, "| a | old |",
                          "| b | new |", "| b | newer |", "| c | new |", comparison.END, "after"],
                         page.read_text().splitlines())

    def test_bars_do_not_break_the_table(self):
        (line,) = comparison.lines_of_table("a", "N", [comparison.Result("m", 1.0, 2.5, 3, "a | line")])
        self.assertEqual("| a | m | 1 N | 2.5 s | 3 | a / line |", line)

    def test_lines_are_those_of_code(self):
        file = self.folder / "a.py"
        file.write_text('"""A text\nof two lines."""\n\n# Why.\nx = [\n    1,\n]  # here\n')
        self.assertEqual(3, comparison.lines_of_code(file))

    def test_without_their_python_one_line_says_so(self):
        os.environ[comparison.PYTHON] = str(self.folder / "none")
        with self.assertRaisesRegex(comparison.NoRivals, "names no Python"):
            comparison.compare(self.outcome(), self.folder, lambda text: None)


if __name__ == "__main__":
    unittest.main()
