"""`flexcomp diagnose` as a user sees it: what it names, what it leaves alone, what it refuses."""

import csv
import json
import math
import os
import pathlib
import pty
import random
import re
import subprocess
import tempfile
import unittest

PROGRAM = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"
ROBOT = pathlib.Path(os.environ["FLEXCOMP_SOURCE"]) / "host/robots/kr270/robot.yaml"
JOINTS = range(1, 7)
NOISE = 1e-5  # m
PERIOD = 0.01  # s
SANITIZED = os.environ.get("FLEXCOMP_SANITIZED") == "ON"
TOO_SLOW = "takes minutes in the sanitized build, which tries the same on less; the release build runs it"


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)


def read_screen(screen):
    """What comes next; nothing at the end, when nobody has the terminal open any more."""
    try:
        return os.read(screen, 4096)
    except OSError:
        return b""


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


def circle(folder, middle, reach, force):
    """The command of a small circle about a posture (rad), twice in 24 s, under a force that goes round with it and pushes
    besides: for each axis by how much it swings, and about what (N)."""
    lines = [",".join(["t"] + [f"q_cmd_{j}" for j in JOINTS] + ["fx", "fy", "fz", "mx", "my", "mz"])]
    for t in (0.06 * i for i in range(400)):
        turned = 2 * math.pi * t / 12
        q = [m + r * math.sin(turned + 0.9 * k) for k, (m, r) in enumerate(zip(middle, reach))]
        f = [about + by * math.sin(turned + 1.3 * k) for k, (by, about) in enumerate(force)]
        lines.append(",".join(map(repr, [t, *q, *f, 0, 0, 0])))
    path = folder / "path.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


def measured(folder, model, seed, poses=60):
    """The load test as a robot with another model would do it, with measurement noise."""
    return measured_on(load_test(folder, poses, seed), folder, model, random.Random(seed + 1))


def measured_on(path, folder, model, draw, noise=NOISE):
    """A path as a robot with another model would do it, with measurement noise."""
    clean = folder / "clean.csv"
    made = run("simulate", "--model", model, "--path", path, "--out", clean)
    assert made.returncode == 0, made.stderr
    header, *rows = clean.read_text().split()
    at = header.split(",").index("x")
    lines = [header]
    for row in rows:
        cells = [float(cell) for cell in row.split(",")]
        for i in range(at, at + 3):
            cells[i] += draw.gauss(0, noise)
        lines.append(",".join(map(repr, cells)))
    recording = folder / "recording.csv"
    recording.write_text("\n".join(lines) + "\n")
    return recording


def rows(file):
    with open(file, newline="") as stream:
        return list(csv.DictReader(stream))


def swing(t, lag=0.0):
    """Angles (rad) of six joints that swing about a posture, each at its own pace; or of joints that
    have followed them for long as a first-order lag (s)."""
    middle = (0.1, -1.2, 1.4, 0.2, 0.5, 0.1)
    pace = [2 * math.pi * (0.15 + 0.04 * k) for k in range(6)]
    return [q + 0.25 / math.hypot(1, w * lag) * math.sin(w * t + k - math.atan(w * lag))
            for k, (q, w) in enumerate(zip(middle, pace))]


def steps(angles):
    """From each to the next; none from the last."""
    return [b - a for a, b in zip(angles, [*angles[1:], angles[-1]])]


def replace_columns(recording, names, change):
    """Passes the cells of the columns, row by row, through `change`."""
    header, *lines = recording.read_text().splitlines()
    at = [header.split(",").index(name) for name in names]
    changed = [header]
    for line in lines:
        cells = line.split(",")
        for place, value in zip(at, change(*(float(cells[k]) for k in at))):
            cells[place] = repr(value)
        changed.append(",".join(cells))
    recording.write_text("\n".join(changed) + "\n")


def scara(tilt):
    """A SCARA's URDF, and its robot.yaml; the second axis is tilted by so much (rad)."""
    places = (("0 0 0.3", "0 0 0"), ("0.35 0 0", f"{tilt} 0 0"), ("0.3 0 0", "0 0 0"), ("0 0 0", "0 0 0"))
    links = "".join(f'<link name="l{k}"/>' for k in range(5))
    joints = "".join(
        f'<joint name="j{k}" type="{"prismatic" if k == 3 else "revolute"}"><parent link="l{k - 1}"/><child link="l{k}"/>'
        f'<origin xyz="{place}" rpy="{turn}"/><axis xyz="0 0 1"/><limit lower="-{0.1 if k == 3 else 3}" upper="{0.1 if k == 3 else 3}" effort="200" velocity="3"/></joint>'
        for k, (place, turn) in enumerate(places, start=1))
    yaml = ("schema: flexcomp/robot/1\nname: scara\nurdf: scara.urdf\nbase_link: l0\ntool_link: l4\ngravity: [0, 0, 0]\n"
            "joints:\n" + "".join(f"  j{k}: {{compliance: 1.0e-6}}\n" for k in range(1, 5)))
    return f'<robot name="scara">{links}{joints}</robot>', yaml


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

    def diagnosis(self, recording, model=ROBOT, options=()):
        done = run("diagnose", "--model", model, "--recording", recording, "--out", self.out, *options)
        self.assertEqual(done.returncode, 0, done.stderr)
        return json.loads((self.out / "diagnosis.json").read_text())

    def only_finding(self, recording, effect, joint, model=ROBOT, options=()):
        found = self.diagnosis(recording, model, options)
        self.assertEqual([(f["effect"], f["joint"]) for f in found["findings"]], [(effect, joint)],
                         found["unexplained"])
        return found["findings"][0]

    def simulated(self, recording, model=ROBOT):
        """The rows of what the model says instead of the recording."""
        out = self.folder / "simulated.csv"
        made = run("simulate", "--model", model, "--recording", recording, "--out", out)
        self.assertEqual(made.returncode, 0, made.stderr)
        return rows(out)

    def recorded(self, columns, values):
        """A recording of so many rows of numbers, one every PERIOD."""
        recording = self.folder / "recording.csv"
        lines = [",".join(map(repr, [i * PERIOD, *row])) for i, row in enumerate(values)]
        recording.write_text("\n".join([",".join(["t", *columns]), *lines]) + "\n")
        return recording

    def torques(self, joint, friction, model=ROBOT):
        """A recording of the joints swinging, with torques by the model, friction, and noise."""
        columns = [f"q_meas_{k}" for k in JOINTS] + [f"tau_{k}" for k in JOINTS]
        swings = [swing(i * PERIOD) for i in range(2500)]
        recording = self.recorded(columns, [[*angles, *[0.0] * 6] for angles in swings])
        simulated = self.simulated(recording, model)
        extra = iter(friction([angles[joint - 1] for angles in swings]))
        draw = random.Random(7)
        shown = [[float(row[f"tau_{k}"]) + draw.gauss(0, 2) + (next(extra) if k == joint else 0)
                  for k in JOINTS] for row in simulated]
        torque = iter(shown)
        replace_columns(recording, columns[6:], lambda *_: next(torque))
        return recording

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

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_spring_that_pulls_the_tool_toward_a_place_is_named_and_found_there(self):
        place, rest, stiffness = (1.4, -0.6, 3.2), 0.7, 900.0  # m, m, N/m
        axes, forces = list("xyz"), ["fx", "fy", "fz"]
        recording = measured(self.folder, ROBOT, seed=3)

        def with_pull(*force_and_tcp):
            spring = [p - at for p, at in zip(place, force_and_tcp[3:])]
            pull = stiffness * (1 - rest / math.hypot(*spring))
            return [force + pull * along for force, along in zip(force_and_tcp, spring)]

        draw, told = random.Random(5), iter(rows(recording))
        replace_columns(recording, forces + axes, lambda *old: [*with_pull(*old), *old[3:]])
        bent = iter(self.simulated(recording))
        replace_columns(recording, axes, lambda *_: [float(row_at) + draw.gauss(0, NOISE)
                                                     for row_at in map(next(bent).get, axes)])
        replace_columns(recording, forces, lambda *_: map(float, map(next(told).get, forces)))
        found = self.only_finding(recording, "tool_pull", None)["parameters"]
        for axis, expected in zip("xyz", place):
            self.assertAlmostEqual(found[axis]["value"], expected, delta=0.15)
        self.assertAlmostEqual(found["stiffness"]["value"], stiffness, delta=0.1 * stiffness)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
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

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_measuring_frame_that_is_not_the_base_frame_is_named(self):
        recording = measured(self.folder, ROBOT, seed=4)
        shift, turn = (0.4e-3, -0.3e-3, 0.2e-3), (3e-4, -2e-4, 2.5e-4)  # m, rad

        def moved(x, y, z):
            a, b, c = turn
            return (x + shift[0] + b * z - c * y, y + shift[1] + c * x - a * z,
                    z + shift[2] + a * y - b * x)  # to first order, which is exact to 0.1 µm here

        replace_columns(recording, "xyz", moved)
        finding = self.only_finding(recording, "base_frame", None)
        for name, value in zip(("x", "y", "z", "rx", "ry", "rz"), (*shift, *turn)):
            found = finding["parameters"][name]
            self.assertAlmostEqual(found["value"], value, delta=4 * found["std"] + 1e-7)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_tilted_joint_axis_is_named(self):
        urdf = (self.folder / "kr270.urdf").read_text()
        joint = urdf.index('<joint name="joint_a4"')
        place = urdf.index('rpy="0 0 0"', joint)
        (self.folder / "kr270.urdf").write_text(urdf[:place] + 'rpy="0 1e-3 0"' + urdf[place + 11:])
        true = self.folder / "true.yaml"
        true.write_text(ROBOT.read_text())
        finding = self.only_finding(measured(self.folder, true, seed=5), "joint_axis", 4)
        tilt = finding["parameters"]["tilt_y"]
        self.assertAlmostEqual(tilt["value"], 1e-3, delta=4 * tilt["std"])

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_tilted_axis_is_named_of_an_arm_whose_tool_moves_in_a_plane(self):
        angles = [[math.sin(0.61 * t), 0.9 + 0.5 * math.sin(0.47 * t + 1), 0.02 * math.sin(0.9 * t), math.sin(t)]
                  for t in (i * PERIOD * 4 for i in range(1000))]
        recording = self.recorded([f"q_meas_{k}" for k in range(1, 5)] + list("xyz"), [[*q, 0, 0, 0] for q in angles])
        for name, tilt in (("true", 5e-4), ("nominal", 0)):
            urdf, yaml = scara(tilt)
            (self.folder / f"{name}.urdf").write_text(urdf)
            (self.folder / f"{name}.yaml").write_text(yaml.replace("scara.urdf", f"{name}.urdf"))
        draw, shown = random.Random(3), iter(self.simulated(recording, self.folder / "true.yaml"))
        replace_columns(recording, "xyz", lambda *_: [float(at) + draw.gauss(0, 2 * NOISE)
                                                      for at in map(next(shown).get, "xyz")])
        found = self.only_finding(recording, "joint_axis", 2, self.folder / "nominal.yaml")["parameters"]
        self.assertAlmostEqual(found["tilt_x"]["value"], 5e-4, delta=1e-5)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_friction_that_builds_up_after_reversals_is_named(self):
        level, slip, gap, joint = 250.0, 0.02, 0.03, 2  # N·m, rad

        def friction(angles):
            """A slider on a spring with a gap: the strain of the contact, step by step."""
            strain, last = 0.0, angles[0]
            for angle in angles:
                strain = min(max(strain + angle - last, -gap / 2 - slip), gap / 2 + slip)
                last = angle
                yield math.copysign(level * min(max((abs(strain) - gap / 2) / slip, 0), 1), strain)

        finding = self.only_finding(self.torques(joint, friction), "friction_hysteresis", joint)
        for name, value in (("torque", level), ("slip", slip), ("gap", gap)):
            self.assertAlmostEqual(finding["parameters"][name]["value"], value, delta=0.03 * value)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_friction_that_grows_with_the_load_is_named_where_it_is_the_only_cause(self):
        def friction(angles):
            carried = (abs(float(row["tau_2"])) for row in rows(self.folder / "simulated.csv"))
            return [0.1 * load * math.copysign(1, step) for load, step in zip(carried, steps(angles))]

        heavy = self.changed_model("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]")
        found = self.only_finding(self.torques(2, friction, heavy), "load_friction", 2, heavy)
        self.assertAlmostEqual(found["parameters"]["coefficient"]["value"], 0.1, delta=0.005)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_torque_that_is_measured_with_another_gain_is_named(self):
        def share(_):
            return [-0.12 * float(row["tau_3"]) for row in rows(self.folder / "simulated.csv")]

        heavy = self.changed_model("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]")
        found = self.only_finding(self.torques(3, share, heavy), "torque_gain", 3, heavy)
        self.assertAlmostEqual(found["parameters"]["gain"]["value"], -0.12, delta=0.005)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_robot_that_does_not_stand_level_is_named_by_the_torques_of_its_weight(self):
        leaning = self.changed_model("gravity: [0, 0, 0]", "gravity: [0.2, -0.1, -9.8074]")
        recording = self.torques(1, lambda angles: [0.0] * len(angles), leaning)
        level = self.changed_model("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]")
        found = self.only_finding(recording, "gravity_tilt", None, level)["parameters"]
        self.assertAlmostEqual(found["rx"]["value"], -0.1 / 9.81, delta=5e-4)
        self.assertAlmostEqual(found["ry"]["value"], -0.2 / 9.81, delta=5e-4)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_an_encoder_with_another_zero_is_named_by_the_torques_of_the_weights(self):
        zero = 0.015  # rad; the joint stands so much further than it reads
        heavy = self.changed_model("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]")
        moved = [f"q_meas_{k}" for k in JOINTS]
        turned = self.recorded([*moved, *[f"tau_{k}" for k in JOINTS]], [
            [q + (zero if k == 2 else 0) for k, q in enumerate(swing(i * PERIOD))] + [0.0] * 6 for i in range(2500)])
        draw = random.Random(7)
        torques = [[float(row[f"tau_{k}"]) + draw.gauss(0, 2) for k in JOINTS] for row in self.simulated(turned, heavy)]
        recording = self.recorded([*moved, *[f"tau_{k}" for k in JOINTS]], [
            swing(i * PERIOD) + torques[i] for i in range(2500)])
        found = self.only_finding(recording, "joint_offset", 3, heavy)
        self.assertAlmostEqual(found["parameters"]["offset"]["value"], zero, delta=1e-3)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_viscous_friction_unlike_in_its_two_directions_is_named(self):
        joint, forwards, backwards = 3, 900.0, 500.0  # N·m·s/rad

        def friction(angles):
            speeds = [(b - a) / PERIOD for a, b in zip(angles, angles[1:])]
            speeds = [speeds[0], *((a + b) / 2 for a, b in zip(speeds, speeds[1:])), speeds[-1]]
            return [speed * (forwards if speed > 0 else backwards) for speed in speeds]

        finding = self.only_finding(self.torques(joint, friction), "viscous_friction", joint)
        self.assertAlmostEqual(finding["parameters"]["forward"]["value"], forwards, delta=15)
        self.assertAlmostEqual(finding["parameters"]["backward"]["value"], backwards, delta=15)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_what_drives_a_joint_one_way_is_no_friction(self):
        joint, drive = 3, 400.0  # N·m·s/rad

        def pull(angles):
            speeds = [(b - a) / PERIOD for a, b in zip(angles, angles[1:])]
            return [-drive * abs(speed) for speed in [*speeds, speeds[-1]]]

        found = self.diagnosis(self.torques(joint, pull))
        self.assertNotEqual(found["verdict"], "no_mismatch")
        self.assertNotIn("viscous_friction", [f["effect"] for f in found["findings"]])

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_lag_is_named_by_torques_that_jump_where_dry_friction_turns(self):
        joint, lag = 2, 0.08  # s
        model = self.changed_model("{compliance: 0.29e-6}", "{compliance: 0.29e-6, coulomb: 400}")
        columns = [f"q_cmd_{k}" for k in JOINTS] + [f"tau_{k}" for k in JOINTS]
        commands = [swing(i * PERIOD) for i in range(2500)]
        followed = [[*command, *[0.0] * 6] for command in commands]
        for i, row in enumerate(followed):
            row[joint - 1] = swing(i * PERIOD, lag)[joint - 1]
        draw = random.Random(9)
        torques = [[float(row[name]) + draw.gauss(0, 20) for name in columns[6:]]
                   for row in self.simulated(self.recorded(columns, followed), model)]
        late = self.recorded(columns, map(list.__add__, commands, torques))
        found = self.only_finding(late, "servo_lag", joint, model)["parameters"]["time_constant"]
        self.assertAlmostEqual(found["value"], lag, delta=0.02 * lag)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_loop_is_named_though_the_joint_was_loaded_before_the_recording(self):
        joint, compliance, amplitude, yield_torque = 2, 0.29e-6, 2e-4, 1500.0  # rad/(N·m), rad, N·m
        links = [f"q_link_{k}" for k in JOINTS]
        columns = [f"q_meas_{k}" for k in JOINTS] + ["fx", "fy", "fz", "mx", "my", "mz"]
        times = [i * PERIOD for i in range(2500)]
        loaded = [[*swing(t), 200 * math.sin(0.7 * t), 300 * math.cos(0.5 * t),
                   -900 * math.cos(0.9 * t), 0.0, 0.0, 0.0] for t in times]
        blank = self.recorded(columns + links, [[*row, *[0.0] * 6] for row in loaded])
        angles = [[float(row[name]) for name in links] for row in self.simulated(blank)]
        draw = random.Random(10)
        loop, before = 0.0, 0.0
        for t, row in zip(times, angles):
            load = (row[joint - 1] - swing(t)[joint - 1]) / compliance
            side = math.copysign(1, load - before)
            loop = side - (side - loop) * math.exp(-abs(load - before) / yield_torque)
            before = load
            row[joint - 1] -= amplitude * loop
            row[:] = [angle + draw.gauss(0, 5e-6) for angle in row]
        recording = self.recorded(columns + links, map(list.__add__, loaded, angles))
        finding = self.only_finding(recording, "hysteresis", joint)
        for name, value in (("amplitude", amplitude), ("yield_torque", yield_torque)):
            self.assertAlmostEqual(finding["parameters"][name]["value"], value, delta=0.03 * value)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_most_of_a_small_mismatch_is_named_where_of_a_large_one_it_would_not_be(self):
        joint, noise = 3, 2.0  # N·m

        def comes_and_goes(level):
            def friction(angles):
                return [math.copysign(level * (1 + 0.5 * math.sin(0.05 * i)), step)
                        for i, step in enumerate(steps(angles))]
            return friction

        finding = self.only_finding(self.torques(joint, comes_and_goes(4 * noise)),
                                    "coulomb_friction", joint, options=["--law-seconds", "0"])
        self.assertAlmostEqual(finding["parameters"]["torque"]["value"], 4 * noise, delta=0.1 * noise)
        large = self.diagnosis(self.torques(joint, comes_and_goes(12 * noise)), options=["--law-seconds", "0"])
        self.assertEqual(large["verdict"], "unexplained")

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_of_two_that_do_not_hold_for_another_recording_the_weaker_is_withdrawn(self):
        small, large = (self.offset_beside_friction_that_do_not_last(offset) for offset in (3, 10))
        self.assertEqual([f["effect"] for f in small["findings"]], ["coulomb_friction"])
        # Without the large offset the friction leaves far more than the noise, and proves nothing.
        self.assertEqual(large["findings"], [])
        self.assertIn("does not predict what was held out", large["unexplained"]["reason"])

    def offset_beside_friction_that_do_not_last(self, offset):
        """The diagnosis of both at one joint, in N·m, where the held-out recording has more."""
        def with_more(wave):
            def friction(angles):
                return [math.copysign(40, step) + offset + wave * math.sin(0.31 * i)
                        for i, step in enumerate(steps(angles))]
            return friction

        held_out = self.torques(3, with_more(8)).rename(self.folder / "held_out.csv")
        return self.diagnosis(self.torques(3, with_more(0)),
                              options=("--holdout", held_out, "--law-seconds", 1))

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_law_is_found_beside_an_effect_where_others_fit_better_and_predict_nothing(self):
        model = ROBOT.parent.parent / "kr360/robot.yaml"
        (self.folder / "kr360.urdf").write_text((model.parent / "kr360.urdf").read_text())
        true = self.folder / "true.yaml"
        true.write_text(model.read_text() + """
effects:
  - {effect: tcp_offset, x: 2.0e-4, y: 0, z: -1.0e-4}
  - {effect: law, place: joint_angle, joint: 3, formula: "-c*lag(tau3, T)", c: 1.0e-7, T: 2.7}
""")
        noise, draw = 1.5e-5, random.Random(1)
        command = circle(self.folder, (0.371, -1.064, 1.288, 0.193, -0.94, 0.72), (0.008, 0.043, 0.063, 0.007, 0.038, 0.01),
                         ((-1200, 130), (340, 520), (1100, 60)))
        fitted = measured_on(command, self.folder, true, draw, noise).rename(self.folder / "fitted.csv")
        command = circle(self.folder, (0.591, -1.02, 1.479, 0.226, -0.947, 0.771), (0.018, 0.028, 0.032, 0.021, 0.03, 0.023),
                         ((120, 280), (840, -50), (1280, 150)))
        held_out = measured_on(command, self.folder, true, draw, noise)
        found = self.diagnosis(fitted, model, options=("--holdout", held_out, "--law-seconds", 600))
        self.assertEqual("explained", found["verdict"])
        self.assertEqual({("tcp_offset", None), ("law", 3)}, {(f["effect"], f["joint"]) for f in found["findings"]})
        self.assertLess(found["final"]["tcp_position"]["holdout_rms"], 1.2 * noise)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_of_two_that_do_the_same_the_one_that_changes_less_is_named(self):
        joint, known, more = 1, 100.0, 40.0  # kg·m^2; the link about its vertical axis does as well

        def rotor(angles):
            ends = zip(angles, angles[1:], angles[2:])
            inner = [(known + more) * (a - 2 * b + c) / PERIOD**2 for a, b, c in ends]
            return [inner[0], *inner, inner[-1]]

        model = self.changed_model("{compliance: 0.54e-6}",
                                   f"{{compliance: 0.54e-6, rotor_inertia: {known}}}")
        finding = self.only_finding(self.torques(joint, rotor), "rotor_inertia", joint, model)
        inertia = finding["parameters"]["inertia"]
        self.assertAlmostEqual(inertia["value"], more, delta=4 * inertia["std"])
        whole = finding["parameters"]["whole_inertia"]
        self.assertAlmostEqual(whole["value"], known + more, delta=4 * whole["std"])
        self.assertIn(("link_mass", "body", joint),
                      [(other["effect"], other["form"], other["joint"]) for other in finding["alternatives"]])

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_what_shows_at_another_joint_is_no_alternative(self):
        recording = self.torques(3, lambda angles: [math.copysign(80, step) for step in steps(angles)])
        # At joint 5 a friction that comes and goes, too much so for any effect to stand.
        pace = iter(enumerate(steps([swing(i * PERIOD)[4] for i in range(2500)])))

        def comes_and_goes(torque):
            i, step = next(pace)
            return (torque + math.copysign(150 * (1 + 0.9 * math.sin(0.05 * i)), step),)

        replace_columns(recording, ("tau_5",), comes_and_goes)
        finding = self.only_finding(recording, "coulomb_friction", 3, options=["--law-seconds", "0"])
        self.assertEqual({3}, {other["joint"] for other in finding["alternatives"]})

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_link_encoders_that_are_late_are_named(self):
        delay = 3e-3  # s
        columns = [*(f"q_meas_{k}" for k in JOINTS), *(f"q_link_{k}" for k in JOINTS)]
        draw = random.Random(8)
        recording = self.recorded(columns, [
            [*swing(t), *(q + draw.gauss(0, 2e-6) for q in swing(t - delay))]
            for t in (i * PERIOD for i in range(2500))])
        stiff = self.folder / "stiff.yaml"
        stiff.write_text(re.sub(r"compliance: \S+e-6", "compliance: 1e-12", ROBOT.read_text()))
        done = run("diagnose", "--model", stiff, "--recording", recording, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        found = json.loads((self.out / "diagnosis.json").read_text())
        self.assertEqual([f["effect"] for f in found["findings"]], ["time_offset"])
        value = found["findings"][0]["parameters"]["delay"]["value"]
        self.assertAlmostEqual(value, delay, delta=2e-5)

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_load_on_a_robot_that_warms_is_named_though_it_may_as_well_be_its_last_link(self):
        heavy = "gravity: [0, 0, -9.81]"
        nominal = self.changed_model("gravity: [0, 0, 0]", heavy)
        loaded = self.folder / "loaded.yaml"
        loaded.write_text(nominal.read_text() + "payload: {mass: 60, com: [0.3, 0, 0.1]}\n")
        recording = measured(self.folder, loaded, seed=6)
        header, *lines = recording.read_text().splitlines()
        warm = [f"{line},{20 + 0.2 * row}" for row, line in enumerate(lines)]
        recording.write_text("\n".join([header + ",temp_c", *warm]) + "\n")
        drift = 1.5e-5  # m/K
        replace_columns(recording, ("x", "temp_c"), lambda x, t: (x + drift * (t - 20), t))
        found = self.diagnosis(recording, nominal)
        named = {(f["effect"], f["joint"]) for f in found["findings"]}
        self.assertEqual(named, {("thermal_drift", None), ("payload", None)})
        groups = [{(each["effect"], each["joint"]) for each in group} for group in found["indistinguishable"]]
        self.assertIn({("payload", None), ("link_mass", 6)}, groups)
        self.assertIsNone(found["suggested_experiment"])  # there is none that could tell them apart

    def test_a_robot_like_its_model_is_left_alone(self):
        found = self.diagnosis(measured(self.folder, ROBOT, seed=2))
        self.assertEqual(found["verdict"], "no_mismatch")
        self.assertEqual(found["findings"], [])
        self.assertTrue(math.isclose(found["noise_floor_rms"]["tcp_position"], NOISE, rel_tol=0.3))

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_terminal_shows_what_is_done_and_a_clean_line_afterwards(self):
        true = self.changed_model("joint_a2: {compliance: 0.29e-6}", "joint_a2: {compliance: 0.40e-6}")
        recording = measured(self.folder, true, seed=1)
        arguments = ["diagnose", "--model", ROBOT, "--recording", recording, "--out", self.out]
        screen, terminal = pty.openpty()
        with subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=terminal, stderr=terminal):
            os.close(terminal)
            shown = b""
            while chunk := read_screen(screen):
                shown += chunk
        os.close(screen)
        work, _, answer = shown.decode().rpartition("\r\033[K")
        self.assertIn("choosing causes, 1 so far, 0 s", work)
        self.assertNotIn("choosing", answer)
        self.assertIn("explained", answer)
        self.assertEqual(run(*arguments).stderr, "")  # which is no terminal

    def test_too_few_samples_are_said_to_be_too_few(self):
        found = self.diagnosis(measured(self.folder, ROBOT, seed=3, poses=4))
        self.assertEqual(found["verdict"], "unexplained")
        self.assertIn("too little data", found["unexplained"]["reason"])
        self.assertEqual(found["findings"], [])

    @unittest.skipIf(SANITIZED, TOO_SLOW)
    def test_a_robot_that_stands_still_where_it_was_held_out_tells_no_torque(self):
        fitted = self.torques(2, lambda angles: [0.0] * len(angles)).rename(self.folder / "a.csv")
        columns = [f"q_meas_{k}" for k in JOINTS] + [f"tau_{k}" for k in JOINTS]
        still = self.recorded(columns, [[*swing(0), *[1.0] * 6]] * 500)
        done = run("diagnose", "--model", ROBOT, "--recording", fitted, "--holdout", still,
                   "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("a joint that stands still counts for none", done.stdout)
        self.assertNotIn("nan", done.stdout)
        found = json.loads((self.out / "diagnosis.json").read_text())
        self.assertIsNone(found["baseline"]["joint_torque"]["holdout_rms"])
        self.assertGreater(found["baseline"]["joint_torque"]["train_rms"], 0)

    def test_positions_in_millimetres_end_in_a_verdict(self):
        recording = measured(self.folder, ROBOT, seed=3, poses=19)
        replace_columns(recording, "xyz", lambda *place: [1000 * value for value in place])
        done = run("diagnose", "--model", ROBOT, "--recording", recording, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("units.position", done.stdout)
        self.assertEqual(json.loads((self.out / "diagnosis.json").read_text())["findings"], [])

    def test_rows_that_are_all_equal_end_in_a_verdict(self):
        path = load_test(self.folder, 1, seed=3)
        header, row = path.read_text().split()
        row = row.partition(",")[2]
        for rows in (1, 20):
            with self.subTest(rows=rows):
                path.write_text("\n".join([header + ",x,y,z", *(f"{t},{row},1.5,0.2,1.1" for t in range(rows))]) + "\n")
                done = run("diagnose", "--model", ROBOT, "--recording", path, "--out", self.out)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_times_since_an_epoch_have_their_picture(self):
        columns = [f"q_meas_{k}" for k in JOINTS] + ["x", "y", "z"]
        recording = self.recorded(columns, [[*swing(k * PERIOD), 1.5, 0.2, 1.1] for k in range(40)])
        replace_columns(recording, ["t"], lambda t: [1.7e9 + t])
        done = run("diagnose", "--model", ROBOT, "--recording", recording, "--law-seconds", 0, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)

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
        broken.write_text("\n".join([lines[0] + ",x,y,z", lines[1] + ",1,2,1e160"]) + "\n")
        self.assert_refused(broken, "broken.csv:2: column 'z': '1e160' is larger than any measurement")
        broken.write_text("t,x,y,z\n0,1,2,3\n")
        self.assert_refused(broken, "joint angles are needed")
        good = measured(self.folder, ROBOT, seed=5, poses=30)
        self.assert_refused(good, "--false-discovery", "--false-discovery", "2")
        self.assert_refused(good, "--law-seconds", "--law-seconds", "-1")
        self.assert_refused(good, "missing.csv", "--holdout", self.folder / "missing.csv")

    def test_nothing_is_written_where_one_of_the_files_cannot_be(self):
        (self.out / "updated_model.yaml").mkdir(parents=True)
        done = run("diagnose", "--model", ROBOT, "--recording", measured(self.folder, ROBOT, 3),
                   "--out", self.out)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual([file.name for file in self.out.iterdir()], ["updated_model.yaml"])

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

    def test_what_is_wrong_with_the_input_is_said_first(self):
        recording = measured(self.folder, ROBOT, seed=9, poses=30)
        replace_columns(recording, "xyz", lambda *position: [1000 * value for value in position])
        done = run("diagnose", "--model", ROBOT, "--recording", recording, "--out", self.out)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith("error (units.position): "), done.stdout)
        checks = json.loads((self.out / "diagnosis.json").read_text())["checks"]
        self.assertEqual([(check["severity"], check["about"], check["name"]) for check in checks],
                         [("error", "recording", "units.position")])
        page = (self.out / "report.html").read_text()
        self.assertLess(page.index("units.position"), page.index("Verdict"))

    def test_angles_in_degrees_are_refused(self):
        recording = measured(self.folder, ROBOT, seed=9, poses=30)
        replace_columns(recording, [f"q_cmd_{k}" for k in JOINTS], lambda *angles: [math.degrees(q) for q in angles])
        done = run("diagnose", "--model", ROBOT, "--recording", recording, "--out", self.out)
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("units.angle", done.stdout)
        self.assertIn("joint angles in degrees", done.stderr)
        self.assertFalse(self.out.exists())

    def test_the_page_tells_each_axis_by_its_own_noise_and_how_it_came_to_be(self):
        found = self.diagnosis(measured(self.folder, ROBOT, seed=7, poses=30))
        self.assertEqual(found["checks"], [])
        page = (self.out / "report.html").read_text()
        self.assertIn(f"flexcomp diagnose --model {ROBOT} --recording", page)
        self.assertIn("flexcomp " + run("--version").stdout.split()[1], page)
        self.assertIn("before, times the noise", page)
        self.assertIn("@media print", page)
        self.assertIsNone(re.search(r"[a-z]+_[a-z]+(, joint| of joint)", page))  # effects in words

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
