"""Planted effects against closed forms and another implementation, and how they are counted."""

import os
import pathlib
import subprocess
import sys
import unittest

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "diagnosis")]

from generator import dynamics, kinematics, robot as robots  # noqa: E402
from in_folder import InFolder  # noqa: E402
from machines import consequences, planting, synthetic, tables  # noqa: E402
from machines.kuka_kr300 import reader as kr300  # noqa: E402
from machines.robot_files import write_robot  # noqa: E402
from machines.study import Finding  # noqa: E402
from machines.urdf_arm import UrdfArm  # noqa: E402

TIME = np.arange(0, 6, 0.004)
OMEGA = 2 * np.pi * np.array([0.3, 0.35, 0.4, 0.45, 0.5, 0.55])
ANGLES = 0.3 + 0.4 * np.sin(OMEGA * TIME[:, None])
SPEEDS = 0.4 * OMEGA * np.cos(OMEGA * TIME[:, None])
PUSHES = -0.4 * OMEGA**2 * np.sin(OMEGA * TIME[:, None])
INSIDE = slice(100, -100)  # where the polynomials of the derivatives have both sides


def swing(**more):
    """A recording of a swing: angles, torques that say nothing, and other columns."""
    columns = {f"q_meas_{k}": angle for k, angle in enumerate(ANGLES.T, 1)}
    return {"t": TIME, **columns, **{f"tau_{k}": np.sin((k + 1) * TIME) for k in range(1, 7)},
            **more}


class WithArm(InFolder):
    def setUp(self):
        super().setUp()
        self.model = write_robot(self.folder, kr300.chain())
        self.arm = UrdfArm(self.model)


class Positions(WithArm):
    def tip(self, q, change=lambda robot: None):
        """(n, 3) by the generator's own kinematics, of a robot that was changed."""
        robot = robots.load(self.model)
        change(robot)
        return kinematics.posture(robot, q).tcp

    def test_the_tool_is_where_another_implementation_has_it(self):
        np.testing.assert_allclose(self.arm.stand(ANGLES).tip, self.tip(ANGLES), atol=1e-12)

    def test_a_zero_moves_the_tool_as_the_joint_would(self):
        law = consequences.JointZero(3, {}, self.arm)
        moved = ANGLES + [0, 0, 2e-3, 0, 0, 0]
        np.testing.assert_allclose(law.shift(ANGLES, 2e-3), self.tip(moved) - self.tip(ANGLES),
                                   atol=1e-12)

    def test_a_link_grows_towards_the_next_joint(self):
        def longer(robot):
            robot.origin[2] *= 1 + 1e-3 / np.linalg.norm(robot.origin[2])

        law = consequences.LinkLength(2, {}, self.arm)
        want = self.tip(ANGLES, longer) - self.tip(ANGLES)
        np.testing.assert_allclose(law.shift(ANGLES, 1e-3), want, atol=1e-12)

    def test_a_tool_is_off_in_its_own_frame(self):
        def off(robot):
            robot.tool = robot.tool + robot.tool_rotation @ [0, 2e-3, 0]

        law = consequences.ToolOffset(None, {"x": 0.0, "y": 1.0, "z": 0.0}, self.arm)
        want = self.tip(ANGLES, off) - self.tip(ANGLES)
        np.testing.assert_allclose(law.shift(ANGLES, 2e-3), want, atol=1e-12)


class Torques(WithArm):
    def check(self, law, amount, want, tolerance):
        found = law.trace(swing(), amount)
        self.assertEqual(list(found), [f"tau_{law.joint}"])
        np.testing.assert_allclose(found[f"tau_{law.joint}"][INSIDE], want[INSIDE], atol=tolerance)

    def test_friction_and_rotors_follow_speed_and_acceleration(self):
        speed, push = SPEEDS[:, 1], PUSHES[:, 1]
        self.check(consequences.ViscousFriction(2, {}, self.arm), 30.0, 30 * speed, 0.02)
        self.check(consequences.RotorInertia(2, {}, self.arm), 5.0, 5 * push, 0.05)
        found = consequences.DryFriction(2, {}, self.arm).trace(swing(), 8.0)["tau_2"]
        turning = np.abs(speed) > 0.05 * np.abs(speed).max()
        np.testing.assert_allclose(found[turning], 8 * np.sign(speed[turning]), atol=0.01)

    def test_steps_of_the_encoders_are_no_acceleration(self):
        coarse = {f"q_meas_{k}": np.round(angle / 2e-3) * 2e-3
                  for k, angle in enumerate(ANGLES.T, 1)}
        found = consequences.RotorInertia(2, {}, self.arm).trace(swing(**coarse), 1.0)["tau_2"]
        left = (found - PUSHES[:, 1])[INSIDE]
        self.assertLess(left.std(), 0.08 * PUSHES[:, 1].std())

    def test_zeros_gains_and_ripples_are_closed_forms(self):
        self.check(consequences.TorqueOffset(4, {}, self.arm), 7.0, 7 + 0 * TIME, 0)
        self.check(consequences.TorqueGain(4, {}, self.arm), 0.1, 0.1 * np.sin(5 * TIME), 1e-12)
        ripple = consequences.TorqueRipple(4, {"order": 30, "phase": 0.4}, self.arm)
        self.check(ripple, 3.0, 3 * np.sin(30 * ANGLES[:, 3] + 0.4), 1e-12)

    def test_late_torques_are_the_same_ones_later(self):
        found = consequences.LateTorques(None, {}, self.arm).trace(swing(), 0.01)
        want = np.sin(2 * (TIME - 0.01)) - np.sin(2 * TIME)
        np.testing.assert_allclose(found["tau_1"][INSIDE], want[INSIDE], atol=1e-6)

    def test_a_payload_needs_what_inverse_dynamics_says(self):
        robot = robots.load(self.model)
        before = dynamics.inverse_dynamics(robot, ANGLES, SPEEDS, PUSHES)
        robot.bodies[-1].append(robots.Body(20.0, robot.tool, np.zeros((3, 3))))
        want = dynamics.inverse_dynamics(robot, ANGLES, SPEEDS, PUSHES) - before
        found = consequences.Payload(None, {}, self.arm).trace(swing(), 20.0)
        for joint in range(6):
            np.testing.assert_allclose(found[f"tau_{joint + 1}"][INSIDE], want[INSIDE, joint],
                                       atol=0.5)


class Sizes(WithArm):
    def test_an_amount_stands_so_many_times_out_of_the_residual(self):
        law, left = consequences.ViscousFriction(3, {}, self.arm), {"tau_3": 2.5, "tau_1": 1.0}
        amount = planting.amount_for(law, swing(), left, 6)
        shown = law.trace(swing(), amount)["tau_3"]
        self.assertAlmostEqual(np.sqrt(np.mean(shown**2)), 15.0)

    def test_only_the_planted_column_changes(self):
        path = tables.write_recording(self.folder / "a.csv", TIME, q_meas=ANGLES, tau=0 * ANGLES)
        law = consequences.TorqueOffset(5, {}, self.arm)
        target = planting._changed(path, law, 4.0, self.folder / "b.csv")
        before, after = tables.read_recording(path), tables.read_recording(target)
        for column in before:
            np.testing.assert_allclose(after[column] - before[column], 4.0 * (column == "tau_5"),
                                       atol=1e-12)

    def test_effects_are_drawn_where_they_show(self):
        rest = swing(**{"q_meas_6": 0 * TIME})
        drawn = consequences.drawn(np.random.default_rng(1), rest, self.arm, 200)
        self.assertNotIn(6, {law.joint for law in drawn})
        self.assertEqual({law.group for law in drawn}, {"tau"})
        self.assertEqual({law.name for law in drawn}, {
            "viscous_friction", "coulomb_friction", "torque_offset", "torque_gain",
            "rotor_inertia", "torque_ripple", "payload", "time_offset"})

    def test_no_rotor_takes_more_torque_than_was_measured(self):
        law = consequences.RotorInertia(2, {}, self.arm)
        recording = swing(tau_2=40 * np.sin(TIME))
        most = law.most_in(recording)
        self.assertAlmostEqual(np.abs(law.trace(recording, most)["tau_2"]).max(),
                               np.abs(recording["tau_2"]).max())

    def test_tool_and_base_are_left_alone_where_the_tool_never_turns(self):
        still = {f"q_meas_{k}": 0 * TIME + angle for k, angle in enumerate(ANGLES[0], 1)}
        columns = {name: 0 * TIME for name in "xyz"}
        names = {law.name for law in consequences.drawn(
            np.random.default_rng(1), swing(**still, **columns), self.arm, 100)}
        self.assertFalse({"tcp_offset", "base_frame"} & names)
        names = {law.name for law in consequences.drawn(
            np.random.default_rng(1), swing(**columns), self.arm, 100)}
        self.assertLessEqual({"tcp_offset", "base_frame"}, names)

    def test_coupled_drives_are_left_alone(self):
        self.arm.coupled = {5, 6}
        drawn = consequences.drawn(np.random.default_rng(1), swing(), self.arm, 200)
        self.assertFalse({5, 6} & {law.joint for law in drawn})


class Counting(WithArm):
    def test_a_name_is_right_at_its_joint_or_where_it_says_the_same(self):
        law = consequences.Payload(None, {}, self.arm)
        for effect, joint, right in (("payload", None, True), ("link_mass", 6, True),
                                     ("link_mass", 5, False), ("torque_gain", None, False)):
            self.assertEqual(law.matches(Finding(effect, joint, {}, "")), right, (effect, joint))

    def test_goals_count_names_and_quiet(self):
        def row(size, found):
            return planting.Planted("m", "e", "x", size, 1.0, found, [], [], "")

        machine = planting.Machine("m", None, self.arm, [], {})
        rows = [row(6, index > 0) for index in range(10)] + [row(12, index > 0) for index in range(10)]
        holds = [met for _, met, _ in planting.goals_met([machine], rows)]
        self.assertEqual(holds, [True, False, True])

    def test_the_command_plants_and_reports(self):
        data = self.folder / "data"
        synthetic.emps(data / "emps")
        tool = self.folder / "flexcomp"
        tool.write_text(f"#!/bin/sh\nexec {sys.executable} {HERE / 'fake_tool.py'} \"$@\"\n")
        tool.chmod(0o755)
        done = subprocess.run(
            [sys.executable, "-m", "machines", "emps", "--plant-effects", "1", "--data", data,
             "--tool", tool, "--out", self.folder / "out"], capture_output=True, text=True,
            env=os.environ | {"PYTHONPATH": str(HERE.parent), "FAKE_ANSWER": "silent"}, check=False)
        self.assertEqual((1, ""), (done.returncode, done.stderr))
        self.assertIn("| emps | 0 of 1 | 0 of 1 | 0 of 1 | 0 of 1 | 0 of 1 | 0 of 1 | 0 of 1 |",
                      done.stdout)
        self.assertIn("holds: unchanged", done.stdout)


if __name__ == "__main__":
    unittest.main()
