"""`flexcomp diagnose` as a user sees it: what it names, what it leaves alone, what it refuses."""

import csv
import json
import math
import os
import pathlib
import random
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"
ROBOT = pathlib.Path(os.environ["FLEXCOMP_SOURCE"]) / "host/robots/kr270/robot.yaml"
JOINTS = range(1, 7)
NOISE = 1e-5  # m


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)


def load_test(folder, poses, seed):
    """A load test's command: random poses and forces."""
    draw = random.Random(seed)
    middle = [0, -1.2, 1.4, 0.3, 0.6, 0.1]
    header = ["t"] + [f"q_cmd_{j}" for j in JOINTS] + ["fx", "fy", "fz", "mx", "my", "mz"]
    lines = [",".join(header)]
    for t in range(poses):
        q = [m + draw.uniform(-0.5, 0.5) for m in middle]
        force = [draw.uniform(-1000, 1000) for _ in range(3)]
        lines.append(",".join(map(str, [t, *q, *force, 0, 0, 0])))
    path = folder / "path.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


def measured(folder, model, seed, poses=60):
    """The load test as a robot with another model would do it, with measurement noise."""
    path = load_test(folder, poses, seed)
    clean = folder / "clean.csv"
    made = run("simulate", "--model", model, "--path", path, "--out", clean)
    assert made.returncode == 0, made.stderr
    draw = random.Random(seed + 1)
    header, *rows = clean.read_text().split()
    at = header.split(",").index("x")
    lines = [header]
    for row in rows:
        cells = [float(cell) for cell in row.split(",")]
        for i in range(at, at + 3):
            cells[i] += draw.gauss(0, NOISE)
        lines.append(",".join(map(repr, cells)))
    recording = folder / "recording.csv"
    recording.write_text("\n".join(lines) + "\n")
    return recording


def rows(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


class Diagnose(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)
        (self.folder / "kr270.urdf").write_text((ROBOT.parent / "kr270.urdf").read_text())
        self.out = self.folder / "out"

    def changed_model(self, old, new):
        text = ROBOT.read_text()
        self.assertIn(old, text)
        file = self.folder / "true.yaml"
        file.write_text(text.replace(old, new))
        return file

    def diagnosis(self, recording):
        done = run("diagnose", "--model", ROBOT, "--recording", recording, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((self.out / "diagnosis.json").read_text())

    def test_a_softer_joint_is_named_measured_and_given_back(self):
        true = self.changed_model("joint_a2: {compliance: 0.29e-6}", "joint_a2: {compliance: 0.40e-6}")
        found = self.diagnosis(measured(self.folder, true, seed=1))
        self.assertEqual(found["schema"], "flexcomp/diagnosis/1")
        self.assertEqual(found["verdict"], "explained")
        self.assertEqual([(f["effect"], f["joint"]) for f in found["findings"]], [("joint_stiffness", 2)])
        change = found["findings"][0]["parameters"]["compliance_change"]
        self.assertAlmostEqual(change["value"], 0.11e-6, delta=5e-9)
        evidence = found["findings"][0]["evidence"]
        self.assertLess(evidence["holdout_rms_after"], 1.5 * NOISE)
        self.assertGreater(evidence["holdout_rms_before"], 5 * NOISE)
        again = run("diagnose", "--model", self.out / "updated_model.yaml", "--recording",
                    self.folder / "recording.csv", "--out", self.folder / "again")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(json.loads((self.folder / "again/diagnosis.json").read_text())["verdict"], "no_mismatch")

    def test_the_simulated_recording_leaves_the_residual_that_the_diagnosis_states(self):
        true = self.changed_model("joint_a2: {compliance: 0.29e-6}", "joint_a2: {compliance: 0.40e-6}")
        recording = measured(self.folder, true, seed=1)
        found = self.diagnosis(recording)
        simulated = self.folder / "simulated.csv"
        for model, rms in ((ROBOT, found["baseline"]), (self.out / "updated_model.yaml", found["final"])):
            made = run("simulate", "--model", model, "--recording", recording, "--out", simulated)
            self.assertEqual(made.returncode, 0, made.stderr)
            squares = [(float(a[c]) - float(b[c])) ** 2 for a, b in zip(rows(recording), rows(simulated))
                       for c in "xyz"]
            channel = rms["tcp_position"]  # three quarters of the rows to fit to, the rest to check
            stated = 0.75 * channel["train_rms"] ** 2 + 0.25 * channel["holdout_rms"] ** 2
            self.assertAlmostEqual(sum(squares) / len(squares) / stated, 1, delta=0.02)

    def test_a_row_without_a_force_is_not_simulated(self):
        recording = measured(self.folder, ROBOT, seed=1)
        header, first, *rest = recording.read_text().splitlines()
        cells = first.split(",")
        cells[header.split(",").index("fx")] = ""
        recording.write_text("\n".join([header, ",".join(cells), *rest]) + "\n")
        simulated = self.folder / "simulated.csv"
        made = run("simulate", "--model", ROBOT, "--recording", recording, "--out", simulated)
        self.assertEqual(made.returncode, 0, made.stderr)
        filled = [row["x"] != "" for row in rows(simulated)]
        self.assertEqual(filled, [False] + [True] * (len(filled) - 1))

    def test_a_robot_like_its_model_is_left_alone(self):
        found = self.diagnosis(measured(self.folder, ROBOT, seed=2))
        self.assertEqual(found["verdict"], "no_mismatch")
        self.assertEqual(found["findings"], [])
        self.assertTrue(math.isclose(found["noise_floor_rms"]["tcp_position"], NOISE, rel_tol=0.3))

    def test_too_few_samples_are_said_to_be_too_few(self):
        found = self.diagnosis(measured(self.folder, ROBOT, seed=3, poses=4))
        self.assertEqual(found["verdict"], "unexplained")
        self.assertIn("too little data", found["unexplained"]["reason"])
        self.assertEqual(found["findings"], [])

    def assert_refused(self, recording, saying, *more, model=ROBOT):
        refused = run("diagnose", "--model", model, "--recording", recording, *more, "--out", self.out)
        self.assertEqual(refused.returncode, 2)
        self.assertEqual(len(refused.stderr.splitlines()), 1, refused.stderr)
        self.assertIn(saying, refused.stderr)
        self.assertFalse(self.out.exists())

    def test_unusable_input_is_refused_in_one_line_and_nothing_is_written(self):
        path = load_test(self.folder, 5, seed=4)
        self.assert_refused(path, "nothing to compare with")
        lines = path.read_text().splitlines()
        broken = self.folder / "broken.csv"
        broken.write_text("\n".join([lines[0], lines[2], lines[1]]) + "\n")
        self.assert_refused(broken, "broken.csv:3")
        broken.write_text("\n".join([lines[0] + ",x,y,z", lines[1] + ",1,2,far"]) + "\n")
        self.assert_refused(broken, "broken.csv:2")
        broken.write_text("t,x,y,z\n0,1,2,3\n")
        self.assert_refused(broken, "joint angles are needed")
        good = measured(self.folder, ROBOT, seed=5, poses=30)
        self.assert_refused(good, "--false-discovery", "--false-discovery", "2")
        self.assert_refused(good, "missing.csv", "--holdout", self.folder / "missing.csv")

    def test_recordings_that_do_not_show_the_same_things_are_refused_together(self):
        first = measured(self.folder, ROBOT, seed=8, poses=30)
        other = self.folder / "other.csv"
        lines = first.read_text().split()
        other.write_text("\n".join([lines[0] + ",temp_c"] + [line + ",20" for line in lines[1:]]) + "\n")
        self.assert_refused(first, "has the columns temp_c", "--recording", other)
        moving = [line.split(",") for line in lines]
        other.write_text("\n".join([lines[0]] + [",".join([str(0.01 * i), *cells[1:]])
                                                 for i, cells in enumerate(moving[1:])]) + "\n")
        self.assert_refused(first, "no load test", "--holdout", other)

    def test_effects_of_a_model_that_are_unknown_or_incomplete_are_refused(self):
        good = measured(self.folder, ROBOT, seed=6, poses=30)
        for effect, saying in (("{effect: backslash, joint: 2}", "'backslash' is unknown"),
                               ("{effect: backlash, joint: 2, form: slack, gap: 1}", "has no form 'slack'"),
                               ("{effect: joint_offset, joint: 2, form: load, offset: 0}", "expected none"),
                               ("{effect: joint_offset, joint: 2}", "needs the parameter 'offset'"),
                               ("{effect: joint_offset, joint: 7, offset: 0}", "expected a joint")):
            model = self.folder / "wrong.yaml"
            model.write_text(ROBOT.read_text() + f"effects: [{effect}]\n")
            self.assert_refused(good, saying, model=model)

    def test_the_report_says_it_in_one_page_without_other_files(self):
        true = self.changed_model("joint_a3: {compliance: 0.42e-6}", "joint_a3: {compliance: 0.6e-6}")
        self.diagnosis(measured(self.folder, true, seed=7))
        page = (self.out / "report.html").read_text()
        self.assertIn("The spring of joint 3 has another stiffness", page)
        self.assertGreaterEqual(page.count("<svg"), 2)
        self.assertNotIn("src=", page)
        self.assertEqual(sorted(path.name for path in self.out.iterdir()),
                         ["diagnosis.json", "report.html", "updated_model.yaml"])


if __name__ == "__main__":
    unittest.main()
