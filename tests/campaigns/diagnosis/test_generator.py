"""The generator of recordings against closed forms, so that it can be the judge of others."""

import csv
import dataclasses
import pathlib
import re
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from generator import (case, detect, dynamics, elasticity, kinematics, machine, memory,  # noqa: E402
                       recording, robot as robots, setup, trajectories)
from generator.effects import CATALOGUE, VARIANTS  # noqa: E402
from generator.effects.base import Scale  # noqa: E402
from generator.motion import Track  # noqa: E402

KR270 = setup.SHIPPED / "kr270" / "robot.yaml"


def heavy_robot():
    robot = robots.load(KR270)
    robot.gravity = np.array([0, 0, -9.81])
    robot.tool = np.array([0.2, 0.15, -0.1])
    return robot


def swing(robot, duration=8.0, rate=200):
    centre = np.array([0.3, -1.2, 1.1, 0.4, 0.9, -0.5])
    return trajectories.fourier(robot, np.random.default_rng(5), rate, duration, 0.15, 0.5, centre)


def drive_of(robot, **more):
    track = swing(robot, **more)
    rng = np.random.default_rng(6)
    wrench = np.cumsum(rng.normal(size=(len(track.time), 6)), 0) * np.array([30.0] * 3 + [3.0] * 3)
    return machine.Drive(track, wrench, 25 + track.time)


class Kinematics(unittest.TestCase):
    def test_the_jacobian_is_the_derivative_of_the_pose(self):
        robot = heavy_robot()
        q = np.random.default_rng(1).uniform(-1, 1, (1, 6))
        found = kinematics.jacobian(kinematics.posture(robot, q))[0]
        step = 1e-6
        for k in range(6):
            ahead = kinematics.posture(robot, q + step * np.eye(6)[k])
            behind = kinematics.posture(robot, q - step * np.eye(6)[k])
            linear = (ahead.tcp - behind.tcp)[0] / (2 * step)
            turn = (ahead.tool_rotation[0] - behind.tool_rotation[0]) / (2 * step)
            spin = turn @ kinematics.posture(robot, q).tool_rotation[0].T
            np.testing.assert_allclose(linear, found[:3, k], atol=1e-8)
            np.testing.assert_allclose([spin[2, 1], spin[0, 2], spin[1, 0]], found[3:, k], atol=1e-8)

    def test_stretched_out_the_arm_reaches_what_its_data_sheet_says(self):
        place = kinematics.posture(robots.load(KR270), np.zeros((1, 6)))
        np.testing.assert_allclose(place.tcp[0], [0.35 + 1.25 + 1.1 + 0.23, 0, 0.75 - 0.055], atol=1e-12)

    def test_inverse_kinematics_comes_back(self):
        robot = heavy_robot()
        q = np.array([0.3, -1.2, 1.1, 0.4, 0.9, -0.5])
        place = kinematics.posture(robot, q[None])
        found = trajectories.inverse_kinematics(robot, q + 0.05, place.tcp, place.tool_rotation[0])
        np.testing.assert_allclose(found[0], q, atol=1e-9)


class Springs(unittest.TestCase):
    def test_a_planar_arm_gives_as_the_closed_form_says(self):
        """u = Σ k Im(conj(a) F) i a with w = x + iz and a from each axis to the point."""
        robot = robots.load(KR270)
        q = np.array([[0, -1.1, 1.3, 0, 0.7, 0]])
        force = 0.3 + 0.8j
        wrench = np.zeros((1, 6))
        wrench[0, [0, 2]] = force.real, force.imag
        place = kinematics.posture(robot, q)
        plane = lambda point: point[0] + 1j * point[2]  # noqa: E731
        expected = 0
        for k in (1, 2, 4):
            arm = plane(place.tcp[0]) - plane(place.origin[k, 0])
            expected += robot.compliance[k] * (arm.conjugate() * force).imag * 1j * arm
        bent, _ = elasticity.settle(robot, [], q, wrench)
        found = plane(bent.tcp[0]) - plane(place.tcp[0])
        self.assertLess(abs(found - expected), 1e-5 * abs(expected))
        self.assertAlmostEqual(0.0, bent.tcp[0, 1], 15)

    def test_the_bent_robot_is_in_equilibrium(self):
        robot = heavy_robot()
        q, wrench = np.array([[0.3, -1.2, 1.1, 0.4, 0.9, -0.5]]), np.full((1, 6), 900.0)
        bent, windup = elasticity.settle(robot, [], q, wrench)
        pull = kinematics.jacobian(bent)[0].T @ wrench[0]
        weight = -dynamics.inverse_dynamics(robot, q + windup, 0 * q, 0 * q)[0]
        np.testing.assert_allclose(windup[0], robot.compliance * (pull + weight), atol=1e-9)

    def test_a_cantilever_bends_as_euler_and_bernoulli_say(self):
        length, bending = 1.2, 3e-7  # m, rad/(N·m); E·I = length / bending
        robot = robots.load(KR270)
        robot.origin[2] = np.array([length, 0, 0])
        compliance = elasticity.beam(robot.origin[2], bending)
        stiffness = length / bending
        force = np.array([0, 0, 100.0, 0, 0, 0])  # at the tip: force and moment at the root follow
        at_root = force + np.concatenate([np.zeros(3), np.cross([length, 0, 0], force[:3])])
        give = compliance @ at_root
        tip = give[:3] + np.cross(give[3:], [length, 0, 0])
        self.assertAlmostEqual(100 * length**3 / (3 * stiffness), tip[2], 12)
        self.assertAlmostEqual(-100 * length**2 / (2 * stiffness), give[4], 12)

    def test_tool_and_base_give_in_their_own_frames(self):
        robot = robots.load(KR270)
        robot.compliance[:] = 0
        q, wrench = np.array([[0.5, -1.2, 1.1, 0.4, 0.9, -0.5]]), np.zeros((1, 6))
        wrench[0, :3] = 100, 200, 300
        rigid = kinematics.posture(robot, q)
        tool, _ = elasticity.settle(robot, [elasticity.Spring(kinematics.TOOL, np.diag(
            [1e-6, 0, 0, 0, 0, 0]))], q, wrench)
        axis = rigid.tool_rotation[0, :, 0]
        np.testing.assert_allclose(tool.tcp[0] - rigid.tcp[0], 1e-6 * axis * (axis @ wrench[0, :3]),
                                   atol=1e-12)
        base, _ = elasticity.settle(robot, [elasticity.Spring(kinematics.BASE, np.diag(
            [0, 0, 0, 1e-9, 0, 0]))], q, wrench)
        angle = 1e-9 * np.cross(rigid.tcp[0], wrench[0, :3])[0]
        np.testing.assert_allclose(base.tcp[0] - rigid.tcp[0],
                                   np.cross([angle, 0, 0], rigid.tcp[0]), atol=1e-10)


class Dynamics(unittest.TestCase):
    def test_torque_feeds_kinetic_and_potential_energy(self):
        robot = heavy_robot()
        track = swing(robot, rate=2000, duration=2.0)
        torque = dynamics.inverse_dynamics(robot, track.q, track.velocity, track.acceleration)
        power = (torque * track.velocity).sum(1)
        change = np.gradient(self.energy(robot, track), track.step)
        np.testing.assert_allclose(change[5:-5], power[5:-5], atol=2e-4 * np.abs(power).max())

    @staticmethod
    def energy(robot, track):
        """From where the bodies are alone: speeds by differences, spin from the turning frames."""
        place = kinematics.posture(robot, track.q)
        total = np.zeros(len(track.time))
        for k, bodies in enumerate(robot.bodies):
            rate = np.gradient(place.rotation[k], track.step, axis=0)
            spin = np.swapaxes(place.rotation[k], 1, 2) @ rate
            omega = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], 1)
            for body in bodies:
                com = place.origin[k] + place.rotation[k] @ body.com
                speed = np.gradient(com, track.step, axis=0)
                total += 0.5 * body.mass * (speed**2).sum(1) - body.mass * com @ robot.gravity
                total += 0.5 * np.einsum("ni,ij,nj->n", omega, body.inertia, omega)
        return total

    def test_the_motor_holds_against_the_wrench(self):
        """tau = inverse dynamics + friction − Jᵀ·wrench: a push up relieves the motor of weight."""
        robot = heavy_robot()
        drive = drive_of(robot)
        with_wrench = machine.measure(machine.nominal(robot), drive, ["tau"])["tau"]
        free = dataclasses.replace(drive, wrench=0 * drive.wrench, loads={}, predictions={})
        without = machine.measure(machine.nominal(robot), free, ["tau"])["tau"]
        matrix = kinematics.jacobian(kinematics.posture(robot, drive.track.q))
        np.testing.assert_allclose(without - with_wrench,
                                   np.einsum("nij,ni->nj", matrix, drive.wrench), atol=1e-8)


class Memory(unittest.TestCase):
    def test_a_lag_trails_a_ramp_by_its_time_constant(self):
        time = np.arange(0, 1, 1e-3)
        ramp = np.outer(time, np.full(6, 0.2))
        late = memory.first_order_lag(Track(time, ramp, np.full_like(ramp, 0.2), 0 * ramp),
                                      np.full(6, 0.03))
        np.testing.assert_allclose(late.q, ramp - 0.2 * 0.03, atol=1e-12)
        np.testing.assert_allclose(late.velocity, 0.2, atol=1e-9)

    def test_a_lag_turns_a_sine_as_its_transfer_function_says(self):
        time, omega, lag = np.arange(0, 4, 1e-3), 6.0, 0.05
        wave = np.tile(np.sin(omega * time)[:, None], 6)
        late = memory.first_order_lag(Track(time, wave, wave, wave), np.full(6, lag)).q[2000:, 0]
        gain = 1 / (1 + 1j * omega * lag)
        expected = np.abs(gain) * np.sin(omega * time[2000:] + np.angle(gain))
        np.testing.assert_allclose(late, expected, atol=1e-5)

    def test_play_follows_half_a_gap_behind(self):
        x = np.concatenate([np.linspace(0, 1, 100), np.linspace(1, -1, 200)])
        lost = memory.motion_play(x, 0.1) - x
        self.assertAlmostEqual(-0.1, lost[99])
        self.assertAlmostEqual(0.1, lost[-1])

    def test_a_gear_changes_flank_once_the_reversed_torque_beats_the_drag(self):
        torque = np.array([5.0, 1.0, -1.0, -3.0, 1.0, 3.0])
        np.testing.assert_array_equal(memory.flank(torque, 2.0), [1, 1, 1, -1, -1, 1])

    def test_hysteresis_is_a_loop_whatever_the_rate(self):
        for loop in (memory.bouc_wen, memory.prandtl_ishlinskii):
            with self.subTest(loop=loop.__name__):
                fine, coarse = (100 * np.sin(np.linspace(0, 4 * np.pi, n)) for n in (4001, 401))
                z = loop(fine, 30.0)
                self.assertLessEqual(np.abs(z).max(), 1.0)
                np.testing.assert_allclose(z[::10], loop(coarse, 30.0), atol=5e-3)
                area = (0.5 * (z[2001:] + z[2000:-1]) * np.diff(fine[2000:])).sum()
                self.assertGreater(area, 50.0)  # what a loop of ±100 takes from each turn
        rise = np.linspace(0, 1000, 100001)
        for loop in (memory.bouc_wen, memory.prandtl_ishlinskii):
            missing = 1 - loop(rise, 30.0)
            self.assertAlmostEqual(30.0, 0.5 * (missing[1:] + missing[:-1]).sum() * rise[1], 3)
        self.assertAlmostEqual(1 - np.exp(-2), memory.bouc_wen(np.linspace(0, 60, 100), 30.0)[-1], 12)

    def test_a_mode_follows_slowly_and_rings_at_its_frequency(self):
        step, frequency, damping = 1e-3, 10.0, 0.05
        np.testing.assert_allclose(memory.mode(np.full(500, 3.0), step, frequency, damping), 3.0)
        time = np.arange(0, 20, step)
        ring = memory.mode(np.sin(2 * np.pi * frequency * time), step, frequency, damping)
        self.assertAlmostEqual(1 / (2 * damping), ring[-1000:].max(), delta=0.02)


class Effects(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.robot = heavy_robot()
        cls.robot.coulomb[:], cls.robot.viscous[:] = 50, 50
        cls.drive = drive_of(cls.robot, duration=6.0, rate=100)
        cls.plain = machine.measure(machine.nominal(cls.robot), cls.drive, machine.GROUPS)
        cls.scale = Scale(load=np.full(6, 2e3), force=1e3, torque=np.full(6, 5e3),
                          speed=np.full(6, 0.5), acceleration=np.full(6, 1.0), span=np.full(6, 1.0))

    def changed(self, effect, joint):
        rng = np.random.default_rng(3)
        concealed = machine.Machine(self.robot.copy())
        effect.apply(concealed, joint, effect.draw(rng, joint, self.robot, self.scale))
        shown = machine.measure(concealed, self.drive, machine.GROUPS)
        return {group: shown[group] - self.plain[group] for group in machine.GROUPS}

    def test_each_effect_changes_only_what_it_should(self):
        for effect in CATALOGUE.values():
            joint = effect.joints[-1]
            with self.subTest(effect=effect.name, joint=joint):
                change = self.changed(effect, joint)
                moved = {group for group, values in change.items() if np.abs(values).max() > 1e-9}
                seen = set(effect.groups)
                if effect.name.startswith("wrench"):
                    seen = {"wrench"}  # the truth stays; what is predicted from the reading does not
                if effect.name == "servo_lag":
                    seen |= {"q_meas", "q_link"}
                if effect.name == "time_offset":
                    seen |= {"wrench"}
                if effect.name in ("joint_offset", "link_length"):
                    seen |= {"tau", "q_link"}  # levers of weights and wrench: far below the noise
                self.assertTrue(moved, "nothing changes")
                self.assertLessEqual(moved, seen)

    def test_a_joint_effect_in_torque_stays_at_its_joint(self):
        for name in ("coulomb_friction", "viscous_friction", "stribeck_friction", "rotor_inertia",
                     "torque_ripple", "torque_offset", "resonance"):
            change = np.abs(self.changed(CATALOGUE[name], 3)["tau"]).max(0)
            # The last bits of a sum depend on where NumPy's arrays happen to lie in memory.
            self.assertEqual([2], list(np.flatnonzero(change > 1e-9)), name)

    def test_a_wrench_bias_is_constant_in_the_tool_frame(self):
        change = self.changed(CATALOGUE["wrench_bias"], None)["wrench"][:, :3]
        rotation = kinematics.posture(self.robot, self.drive.track.q).tool_rotation
        local = np.einsum("nji,nj->ni", rotation, change)
        np.testing.assert_allclose(local, np.tile(local[0], (len(local), 1)), atol=1e-9)
        self.assertGreater(np.ptp(change, 0).max(), 1.0)

    def test_a_compensator_pulls_the_arm_up_and_relieves_its_motor(self):
        q = np.zeros((2, 6))
        q[:, 1] = -np.pi / 2, -np.pi / 4
        concealed = machine.Machine(self.robot.copy())
        effect = CATALOGUE["gravity_compensator"]
        effect.apply(concealed, 2, {"preload": 1e4, "rate": 1e4, "a": 0.5, "b": 0.2})
        upright, leaning = concealed.balance(q)[:, 1]
        self.assertAlmostEqual(0.0, upright)
        weight = -dynamics.inverse_dynamics(self.robot, q, 0 * q, 0 * q)[1, 1]
        self.assertLess(leaning * weight, 0)
        # The pull is the slope of the energy that the spring stores.
        step = 1e-6
        length = [np.sqrt(0.5**2 + 0.2**2 - 2 * 0.5 * 0.2 * np.cos(np.pi / 4 + sign * step))
                  for sign in (-1, 1)]
        energy = [1e4 * (x - 0.3) + 0.5 * 1e4 * (x - 0.3) ** 2 for x in length]
        self.assertAlmostEqual(-(energy[1] - energy[0]) / (2 * step), leaning, 3)

    def test_late_columns_show_what_was(self):
        effect = CATALOGUE["time_offset"]
        concealed = machine.Machine(self.robot.copy())
        effect.apply(concealed, None, {"delay": 0.02, "group": "xyz"})
        shown = machine.measure(concealed, self.drive, ["xyz"])["xyz"]
        np.testing.assert_allclose(shown[2:], self.plain["xyz"][:-2], atol=1e-9)

    def test_every_kind_conceals_every_effect_that_it_claims(self):
        self.assertEqual(27, len(CATALOGUE))
        for effect in CATALOGUE.values():
            self.assertTrue(effect.kinds)


class Variants(unittest.TestCase):
    """Forms of the catalogue's effects that its laws lack."""

    @staticmethod
    def shown(effect, joint, parameters, groups=("xyz", "tau", "wrench")):
        robot = heavy_robot()
        truth = machine.Machine(robot.copy())
        effect.apply(truth, joint, parameters)
        return machine.measure(truth, drive_of(robot), groups)

    def assert_alike(self, form, parameters, usual, joint=None):
        varied = next(effect for effect in VARIANTS if effect.form == form)
        found = self.shown(varied, joint, parameters)
        expected = self.shown(CATALOGUE[varied.name], joint, usual)
        for group, values in expected.items():
            effect = values - self.shown(CATALOGUE["tcp_offset"], None, dict.fromkeys("xyz", 0.0))[group]
            rounding = 1e-12 * np.abs(values).max()
            np.testing.assert_allclose(found[group], values, rtol=0,
                                       atol=2e-3 * np.ptp(effect) + rounding)

    def test_each_has_a_form_of_its_own_and_a_name_that_is_known(self):
        self.assertEqual(len(VARIANTS), len({(effect.name, effect.form) for effect in VARIANTS}))
        for effect in VARIANTS:
            self.assertIn(effect.name, CATALOGUE)

    def test_where_its_form_vanishes_it_is_the_catalogues(self):
        growth = {"x": 2e-5, "y": -1e-5, "z": 3e-5}
        self.assert_alike("behind the temperature", growth | {"behind": 1e-6}, growth)
        loop = {"amplitude": 2e-4, "sliding": 1.0, "yield_torque": 300.0}
        self.assert_alike("with a threshold", loop | {"threshold": 0.0}, loop, 2)
        self.assert_alike("side by torque", {"gap": 4e-4}, {"gap": 4e-4, "hold": 1e-9}, 3)

    def test_a_tool_that_grows_moves_along_itself(self):
        robot = heavy_robot()
        drive = drive_of(robot)
        grown = self.shown(next(e for e in VARIANTS if e.form == "along the tool"), None, {"growth": 1e-5})
        cold = self.shown(CATALOGUE["tcp_offset"], None, dict.fromkeys("xyz", 0.0))
        length = np.linalg.norm(grown["xyz"] - cold["xyz"], axis=1)
        np.testing.assert_allclose(length, 1e-5 * (drive.temperature - drive.temperature[0]), atol=1e-9)

    def test_a_clock_that_runs_slow_shows_where_the_joints_were(self):
        robot = heavy_robot()
        drive, rate = drive_of(robot), 1e-3
        late = self.shown(next(e for e in VARIANTS if e.form == "a clock that runs slow"), None,
                          {"rate": rate}, ("xyz",))["xyz"]
        right = machine.measure(machine.Machine(robot.copy()), drive, ("xyz",))["xyz"]
        time = drive.track.time
        expected = np.column_stack([np.interp(time - rate * (time - time[0]), time, column)
                                    for column in right.T])
        moved = np.abs(expected - right).max()
        self.assertLess(np.abs(late - expected).max(), 0.1 * moved)


class Rules(unittest.TestCase):
    def test_a_trace_within_the_span_of_another_is_equivalent(self):
        rng = np.random.default_rng(2)
        matrix = rng.normal(size=(300, 3))
        trace = matrix @ [1.0, -2.0, 0.5]
        correlation, left = detect.explain(trace, matrix, 1.0)
        self.assertAlmostEqual(1.0, correlation)
        self.assertLess(left, 1e-9)
        correlation, left = detect.explain(rng.normal(size=300), matrix, 2.0)
        self.assertLess(correlation, 0.5)
        self.assertGreater(left, 20.0)


def words_and_numbers(file):
    """The words of a text file, and its numbers (n,)."""
    number = r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"
    text = file.read_text()
    return re.sub(number, "#", text), np.array(re.findall(number, text), float)


class Cases(unittest.TestCase):
    def write(self, family, seed):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        folder = pathlib.Path(scratch.name)
        return case.write(family, seed, folder), folder

    def test_a_seed_gives_the_same_files_every_time(self):
        (_, one), (_, other), (_, third) = (self.write("clean", seed) for seed in (4, 4, 10))
        names = sorted(path.name for path in one.iterdir())
        self.assertEqual(names, sorted(path.name for path in other.iterdir()))
        for name in names:
            words, numbers = words_and_numbers(one / name)
            other_words, other_numbers = words_and_numbers(other / name)
            self.assertEqual(words, other_words, name)
            # Sums come out otherwise in the last bits where arrays lie otherwise in memory.
            np.testing.assert_allclose(numbers, other_numbers, rtol=1e-9, atol=1e-9, err_msg=name)
        self.assertNotEqual((one / "robot.yaml").read_bytes() + (one / "static.csv").read_bytes(),
                            (third / "robot.yaml").read_bytes() + (third / "static.csv").read_bytes())

    def test_recordings_have_whole_groups_and_time_that_increases(self):
        for seed in range(6):  # the six kinds
            truth, folder = self.write("clean", seed)
            for name in truth["recordings"] + [truth["holdout"]] * bool(truth["holdout"]):
                with (folder / name).open() as file:
                    header, *rows = csv.reader(file)
                expected = ["t"] + [column for group in recording.COLUMNS
                                    if group in truth["columns"] for column in recording.COLUMNS[group]]
                self.assertEqual(expected, header)
                self.assertTrue(all(len(row) == len(header) for row in rows))
                time = np.array([float(row[0]) for row in rows])
                self.assertTrue(np.all(np.diff(time) > 0))
                cells = [float(cell) for row in rows for cell in row if cell]
                self.assertTrue(np.all(np.isfinite(cells)))
                if truth["kind"] == "static":
                    np.testing.assert_array_equal(time, np.arange(len(rows)))

    def test_a_clean_recording_differs_from_its_prediction_by_noise_alone(self):
        truth, folder = self.write("clean", 4)
        robot = robots.load(folder / "robot.yaml")
        with (folder / "static.csv").open() as file:
            rows = list(csv.DictReader(file))
        rows = [row for row in rows if row["x"]]
        groups = {group: np.array([[float(row[name]) for name in names] for row in rows])
                  for group, names in recording.COLUMNS.items() if group in truth["columns"]}
        q = groups.get("q_meas", groups.get("q_cmd"))
        bent, _ = elasticity.settle(robot, elasticity.model_springs(robot), q, groups["wrench"])
        error = groups["xyz"] - bent.tcp
        error = error[np.abs(error).max(1) < 2e-4]  # spikes left out
        self.assertGreater(len(error), 0.9 * len(rows))
        self.assertAlmostEqual(1.0, np.sqrt((error**2).mean()) / truth["noise_rms"]["tcp_position"],
                               delta=0.1)

    def test_a_concealed_effect_meets_the_signal_to_noise_rule(self):
        truth, _ = self.write("single", 4)
        effect, = truth["effects"]
        self.assertGreaterEqual(effect["signal_to_noise"], detect.FACTOR)
        for likeness in effect["likest"]:
            self.assertTrue(likeness["correlation"] > detect.EQUIVALENT
                            or likeness["remainder"] >= detect.REMAINDER)


if __name__ == "__main__":
    unittest.main()
