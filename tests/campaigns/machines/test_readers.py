"""Readers of published recordings against closed forms."""

import json
import os
import pathlib
import sys
import unittest
import xml.etree.ElementTree as xml

import numpy as np
import yaml

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent), str(HERE.parent / "diagnosis")]

from generator import dynamics, kinematics, robot as robots  # noqa: E402
from machines import geometry, robot_files, single_axis, study, synthetic, tables  # noqa: E402
from machines.franka_panda import reader as panda  # noqa: E402
from machines.hilti_jaibot import reader as jaibot, tilt  # noqa: E402
from machines.kuka_kr300 import counterbalance, link_encoders, reader as kr300  # noqa: E402
from machines.registry import MACHINES  # noqa: E402
from machines.scratch import Scratch  # noqa: E402

DATA = os.environ.get("FLEXCOMP_MACHINE_DATA")


def tcp(model, angles):
    """(n, 3) m by the generator's own reading of a written robot."""
    return kinematics.posture(robots.load(model), np.asarray(angles)).tcp


def group(recording, name):
    return np.column_stack([recording[column] for column in tables.columns_of(recording, name)])


class Geometry(unittest.TestCase):
    def test_angles_come_back_upright_too(self):
        for rpy in ((0.3, -0.7, 2.0), (3.1, 0.1, -3.0), (0.4, np.pi / 2, 0.0),
                    (0.4, -np.pi / 2, 0.9)):
            rotation = geometry.rotation_of(rpy)
            np.testing.assert_allclose(geometry.rotation_of(geometry.rpy_of(rotation)), rotation,
                                       atol=1e-12)


class Readers(Scratch):
    def test_kr300_has_the_published_kinematics(self):
        (torques, _), _ = self.written("kuka_kr300")
        links = ((0.35, -0.675, 90), (1.15, -0.189, 0), (0.041, 0.189, -90), (0, -1.0, 90),
                 (0, 0, -90), (0, -0.24, 180))
        zeros = (0, -90, 180, 0, 0, 0)
        angles = np.array([0.3, -0.2, 0.4, 1.0, -0.7, 2.0])
        matrix = np.diag([1.0, -1.0, -1.0, 1.0])  # upside down
        for angle, zero, (length, offset, twist) in zip(angles, zeros, links):
            matrix = matrix @ synthetic.dh(angle + np.radians(zero), length, offset,
                                           np.radians(twist))
        np.testing.assert_allclose(tcp(torques.model, [angles])[0], matrix[:3, 3], atol=1e-9)

    def test_kr300_carries_its_cad_masses(self):
        """First moment of all masses about the base, and inertia about axis 1, from the CAD's
        numbers in the frames at the links' ends."""
        (torques, _), _ = self.written("kuka_kr300")
        robot, angles = robots.load(torques.model), np.array([0.3, -0.2, 0.4, 1.0, -0.7, 2.0])
        place = kinematics.posture(robot, angles[None])
        found = sum(body.mass * (place.origin[k, 0] + place.rotation[k, 0] @ body.com)
                    for k, bodies in enumerate(robot.bodies) for body in bodies)
        matrix, moment, inertia = np.diag([1.0, -1.0, -1.0, 1.0]), np.zeros(3), 0.0
        for k, (length, offset, twist) in enumerate(kr300.LINKS):
            matrix = matrix @ synthetic.dh(angles[k] + kr300.ANGLE_AT_ZERO[k], length, offset,
                                           twist)
            body = kr300.BODIES[k]
            center = (matrix @ [*body.center, 1])[:3]
            moment += body.mass * center
            inertia += (body.mass * (center[0] ** 2 + center[1] ** 2)
                        + (matrix[:3, :3] @ body.inertia @ matrix[:3, :3].T)[2, 2])
        payload = (matrix @ [0, 0, 0.1, 1])[:3]
        np.testing.assert_allclose(found, moment + 151 * payload, atol=1e-6)
        inertia += 151 * (payload[0] ** 2 + payload[1] ** 2)
        still, start = np.zeros((1, 6)), np.eye(6)[:1]
        torque = dynamics.inverse_dynamics(robot, angles[None], still, start)
        self.assertAlmostEqual(inertia, torque[0, 0], 6)
        self.assertAlmostEqual(0.00923 * (1798 / 7) ** 2, robot.rotor[0], 6)

    def test_kr300_reflects_torques_to_the_joints(self):
        (torques, encoders), angles = self.written("kuka_kr300")
        recording = tables.read_recording(torques.holdout)
        np.testing.assert_allclose(group(recording, "q_meas"), angles, atol=1e-9)
        np.testing.assert_allclose(recording["tau_2"], 2 * 1872 / 7)
        np.testing.assert_allclose(recording["tau_6"], 6 * 206793 / 1340)
        self.assertNotIn("q_link_1", recording)
        recording = tables.read_recording(encoders.holdout)
        self.assertTrue(np.isnan(recording["q_link_4"]).all())
        _, motor, link, _ = kr300.read(self.folder / "data" / "kuka_kr300" / "kr300_A.csv")
        self.assertAlmostEqual(1e-3, link[0, 2] - motor[0, 2], 9)
        self.assertAlmostEqual(0.0, recording["q_link_3"][0] - recording["q_meas_3"][0], 9)
        self.assertNotIn("tau_1", recording)

    def test_a_late_link_encoder_is_told_by_regression(self):
        (_, encoders), _ = self.written("kuka_kr300")
        found = link_encoders.regress([*encoders.recordings, encoders.holdout], 2)
        self.assertAlmostEqual(0.003, found.delay, 4)
        self.assertGreater(found.explained, 0.99)
        np.testing.assert_allclose(found.zeros, 0, atol=2e-5)

    def test_the_counterbalance_does_the_work_of_its_gas(self):
        """Torque is the change by angle of the ideal gas's energy -C ln(volume)."""
        def energy(angle):
            length = np.sqrt(0.8**2 + 0.2**2 - 2 * 0.8 * 0.2 * np.cos(angle + np.radians(5)))
            area = np.pi / 4 * (0.055**2 - 0.030**2)
            return -1.01 * 296.8 * 328 * 0.159 * np.log(0.00096 - (length - 0.6) * area)

        angles, step = np.linspace(-0.5, 0.5, 11), 1e-5
        slope = (energy(angles + step) - energy(angles - step)) / (2 * step)
        np.testing.assert_allclose(counterbalance.published_torque(angles), slope, rtol=1e-6)

    def test_of_what_was_learnt_only_the_counterbalance_is_kept(self):
        (torques, encoders), _ = self.written("kuka_kr300")
        updated = self.folder / "updated_model.yaml"
        balancer = {"effect": "gravity_compensator", "joint": 2, "stiffness_torque": 7000.0}
        updated.write_text(torques.model.read_text() + "effects: " + json.dumps(
            [{"effect": "coulomb_friction", "joint": 2, "torque": 400.0}, balancer]))
        asked = []

        class Stub:
            def simulate(self, model, recording, out):
                asked.append(yaml.safe_load(model.read_text())["effects"])
                return {"tau_2": np.full(9, 100.0)}

        outcome = study.Outcome(torques, None, updated, {}, {"tau_2": np.full(9, 300.0)}, {})
        trial = study.Trial({"torques": outcome}, Stub(), self.folder)
        np.testing.assert_allclose(counterbalance.found_torque(trial, self.folder), -200.0)
        self.assertEqual([[balancer]], asked)

    def test_tx40_has_the_angles_and_torques_of_the_joints(self):
        (filtered, recorded), angles = self.written("staubli_tx40")
        recording = tables.read_recording(recorded.recordings[0])
        q = group(recording, "q_meas")
        np.testing.assert_allclose(q, angles[:10 * len(q):10], atol=1e-9)
        np.testing.assert_allclose(group(recording, "tau")[0],
                                   [32, 64, 135, -192, 225 + 192, 192])
        # Slow motion passes the filter as it is; it is half a window, 100 ms, shorter at either end.
        recording = tables.read_recording(filtered.recordings[0])
        self.assertAlmostEqual(0.1, recording["t"][0], 9)
        q = group(recording, "q_meas")
        np.testing.assert_allclose(q, angles[500:500 + 10 * len(q):10], atol=1e-4)
        np.testing.assert_allclose(recording["tau_3"], 135)

    def test_panda_has_the_published_kinematics(self):
        (experiment,), _ = self.written("franka_panda")
        links = ((0, 0.333, 0), (0, 0, -90), (0, 0.316, 90), (0.0825, 0, 90), (-0.0825, 0.384, -90),
                 (0, 0, 90), (0.088, 0, 90))
        pose = np.array([0.3, -0.2, 0.4, -1.0, 0.7, 2.0, -0.5])
        matrix = np.eye(4)
        for angle, (length, offset, twist) in zip(pose, links):
            matrix = matrix @ synthetic.modified_dh(angle, length, offset, np.radians(twist))
        robot, found = robots.load(experiment.model), np.eye(4)
        for turn, shift, axis, angle in zip(robot.origin_rotation, robot.origin, robot.axis, pose):
            found[:3, 3] += found[:3, :3] @ shift
            found[:3, :3] = found[:3, :3] @ turn @ robots.rotation_about(axis, angle)
        np.testing.assert_allclose((found @ [*robot.tool, 1])[:3],
                                   (matrix @ [0, 0, 0.107, 1])[:3], atol=1e-9)
        self.assertEqual([0.735522], [body.mass for body in robot.bodies[6]])

    def test_panda_counts_the_controllers_time(self):
        (experiment,), (time, angles) = self.written("franka_panda")
        parts = [tables.read_recording(path)
                 for path in (*experiment.recordings, experiment.holdout)]
        for name, expected in (("t", time), ("q_meas_2", angles[:, 1])):
            found = np.concatenate([part[name] for part in parts])
            np.testing.assert_allclose(found, expected, atol=1e-9)
        self.assertLess(parts[0]["t"][-1], parts[1]["t"][0])
        self.assertEqual([{5.0}, {7.0}], [set(parts[1][name]) for name in ("tau_5", "tau_7")])

    def test_emps_passes_what_is_slow_and_stops_what_hums(self):
        (experiment,), _ = self.written("emps")
        for path in (*experiment.recordings, experiment.holdout):
            recording = tables.read_recording(path)
            slow = np.sin(2 * np.pi * 0.8 * recording["t"])
            np.testing.assert_allclose(recording["q_meas_1"], 0.1 * slow, atol=1e-4)
            np.testing.assert_allclose(recording["tau_1"], 2 * 35.1507 * slow, atol=0.1)
            self.assertNotIn("tau_2", recording)

    def test_a_carriage_is_a_mass_that_slides_level(self):
        robot_files.write_robot(self.folder, single_axis.chain("carriage", 95.0))
        urdf = xml.parse(self.folder / "robot.urdf").getroot()
        (slide,) = [joint for joint in urdf.findall("joint") if joint.get("type") != "fixed"]
        self.assertEqual("prismatic", slide.get("type"))
        rpy = [float(word) for word in slide.find("origin").get("rpy").split()]
        self.assertAlmostEqual(0, geometry.rotation_of(rpy)[2, 2], 9)
        (mass,) = urdf.iter("mass")
        self.assertEqual(95, float(mass.get("value")))

    def test_the_damper_comes_in_newtons_and_metres(self):
        (experiment,), _ = self.written("friction_damper")
        recording = tables.read_recording(experiment.holdout)
        self.assertAlmostEqual(0.0254, recording["q_meas_1"].max(), 6)
        self.assertAlmostEqual(3000 * 4.4482216, recording["tau_1"].max(), 3)
        self.assertEqual(3, len(experiment.recordings))

    def test_ur5_targets_are_what_its_model_says(self):
        (experiment,), grid = self.written("ur5")
        training, held_out = (tables.read_recording(path)
                              for path in (*experiment.recordings, experiment.holdout))
        for recording in (training, held_out):
            error = group(recording, "xyz") - tcp(experiment.model, group(recording, "q_cmd"))
            expected = np.tile([1e-3, 2e-3, -3e-3], (len(error), 1))
            np.testing.assert_allclose(error, expected, atol=1e-9)
        self.assertEqual((170, 50 + 20), (len(training["t"]), len(held_out["t"])))
        np.testing.assert_allclose(np.degrees(held_out["q_cmd_3"][:50]), grid[150:200, 2],
                                   atol=1e-9)

    def test_ur10_has_the_published_kinematics(self):
        (experiment,), angles = self.written("unisa_ur10")
        links = ((0, 0.1273, 90), (-0.612, 0, 0), (-0.5723, 0, 0), (0, 0.163941, 90),
                 (0, 0.1157, -90), (0, 0.0922, 0))
        matrix = np.eye(4)
        for angle, (length, offset, twist) in zip(angles[7], links):
            matrix = matrix @ synthetic.dh(angle, length, offset, np.radians(twist))
        np.testing.assert_allclose(tcp(experiment.model, angles[7:8])[0], matrix[:3, 3], atol=1e-9)

    def test_what_follows_on_the_first_part_of_a_motion_is_held_out(self):
        for name in ("unisa_ur10", "unisa_panda"):
            (experiment,), angles = self.written(name)
            parts = [tables.read_recording(path) for path in (*experiment.recordings, experiment.holdout)]
            self.assertAlmostEqual(0.7, len(parts[0]["t"]) / len(angles), delta=0.01)
            found = np.vstack([group(part, "q_meas") for part in parts])
            np.testing.assert_allclose(found, angles, atol=1e-9)
            self.assertEqual(2.0, parts[1]["tau_2"][0])

    def test_jaibot_is_brought_from_the_stations_frame_to_its_own(self):
        experiments, arm = self.written("hilti_jaibot")
        self.assertEqual(["flat", "pallet"], [experiment.name for experiment in experiments])
        for experiment in experiments:
            held_out = tables.read_recording(experiment.holdout)
            np.testing.assert_allclose(group(held_out, "q_cmd"), arm[1::4], atol=1e-9)
            expected = [synthetic.jaibot_frames(angles)[-1][:3, 3] for angles in arm[1::4]]
            np.testing.assert_allclose(group(held_out, "xyz"), expected, atol=1e-9)
            np.testing.assert_allclose(tcp(experiment.model, arm[1::4]), expected, atol=1e-9)

    def test_motomans_arms_are_brought_from_the_trackers_frame_to_their_own(self):
        experiments, angles = self.written("motoman_ma1400")
        self.assertEqual(["right", "left"], [experiment.name for experiment in experiments])
        for experiment in experiments:
            held_out = tables.read_recording(experiment.holdout)
            np.testing.assert_allclose(group(held_out, "q_cmd"), angles[3::4], atol=1e-9)
            expected = [synthetic.ma1400_reflector(0.02, pose, experiment.name) for pose in angles[3::4]]
            np.testing.assert_allclose(group(held_out, "xyz"), expected, atol=1e-9)
            np.testing.assert_allclose(tcp(experiment.model, angles[3::4]), expected, atol=1e-9)

    def test_motomans_forearm_lies_between_elbow_and_wrist(self):
        """Of the estimated masses, the one whose place a sign would turn over."""
        (right, _), _ = self.written("motoman_ma1400")
        place = kinematics.posture(robots.load(right.model), np.zeros((1, 6)))
        (body,) = robots.load(right.model).bodies[3]
        center = place.origin[3, 0] + place.rotation[3, 0] @ body.com
        elbow, wrist = place.origin[3, 0], place.origin[4, 0]
        self.assertAlmostEqual(0.64, np.linalg.norm(wrist - elbow), 9)
        np.testing.assert_allclose(center, elbow + (0.39 / 0.64) * (wrist - elbow), atol=1e-9)

    def test_tiago_has_torques_where_motors_report_currents(self):
        (experiment,), angles = self.written("pal_tiago")
        parts = [tables.read_recording(path) for path in (*experiment.recordings, experiment.holdout)]
        np.testing.assert_allclose(np.vstack([group(part, "q_meas") for part in parts]), angles, atol=1e-9)
        self.assertAlmostEqual(0.7, len(parts[0]["t"]) / len(angles), delta=0.01)
        np.testing.assert_allclose(group(parts[1], "tau")[0],
                                   [np.nan, 2 * 13.6, 3 * 13.6, -4 * 8.7, -5 * 8.7, np.nan, np.nan, np.nan])

    def test_what_hangs_on_an_arm_by_joints_of_its_own_is_part_of_it(self):
        (experiment,), _ = self.written("pal_tiago")
        root = xml.parse(experiment.model.parent / "robot.urdf").getroot()
        masses = [float(mass.get("value")) for mass in root.iter("mass")]
        np.testing.assert_allclose(masses, 7 * [2] + [2 + synthetic.TIAGO_FINGER])
        kinds = [joint.get("type") for joint in root.findall("joint")]
        self.assertEqual(["prismatic"] + 7 * ["revolute"] + ["fixed"], kinds)
        center = [float(word) for word in root.find("link[@name='link_8']/inertial/origin").get("xyz").split()]
        share = synthetic.TIAGO_FINGER / (2 + synthetic.TIAGO_FINGER)
        np.testing.assert_allclose(center, [0.1 + 0.2 * share, 0, 0.05 + 0.1 * share], atol=1e-9)

    def test_jaibots_sensors_tell_the_springs(self):
        self.written("hilti_jaibot")
        found = tilt.springs(self.folder / "data" / jaibot.FOLDER, "flat")
        np.testing.assert_allclose(found["top of the column"], 2e-5, rtol=1e-6)
        np.testing.assert_allclose(found["base"], 2e-6, rtol=1e-6)


@unittest.skipUnless(DATA, "FLEXCOMP_MACHINE_DATA is not set: no real recordings are read")
class RealFiles(Scratch):
    """The published files themselves, where they are."""

    def experiments(self, name):
        reader = MACHINES[name].reader
        data = pathlib.Path(DATA) / reader.FOLDER
        if not all((data / file).is_file() for file in reader.FILES):
            self.skipTest(f"the data of {name} are not there")
        return reader.write(data, self.folder / name)

    def test_kr300_moves_for_ten_seconds(self):
        torques, encoders = self.experiments("kuka_kr300")
        recording = tables.read_recording(torques.holdout)
        self.assertEqual((2501, 10.0), (len(recording["t"]), recording["t"][-1]))
        delay = link_encoders.regress(encoders.recordings, 2).delay
        self.assertAlmostEqual(3.05e-3, delay, delta=1e-4)

    def test_pandas_angles_and_speeds_agree_once_its_time_is_counted(self):
        self.experiments("franka_panda")
        data = pathlib.Path(DATA) / panda.FOLDER / panda.RECORDING
        time, angle, _ = panda.read(data)
        self.assertAlmostEqual(20.5, time[-1], delta=1.0)
        jumps = np.abs(np.diff(angle, axis=0) / np.diff(time)[:, None]).max(axis=0)
        self.assertLess(jumps.max(), 2.7)  # rad/s: the fastest joint's limit is 2.61

    def test_emps_has_the_forces_of_its_benchmark(self):
        (experiment,) = self.experiments("emps")
        for path, force in zip((*experiment.recordings, experiment.holdout), (52.7, 53.3)):
            found = study.rms(tables.read_recording(path)["tau_1"])
            self.assertAlmostEqual(force, found, delta=0.1)

    def test_the_damper_moves_as_its_runs_are_named(self):
        (experiment,) = self.experiments("friction_damper")
        recording = tables.read_recording(experiment.holdout)
        self.assertAlmostEqual(1.5 * 0.0254, np.abs(recording["q_meas_1"]).max(), delta=1e-3)

    def test_ur5_targets_are_in_the_models_base_frame(self):
        (experiment,) = self.experiments("ur5")
        recording = tables.read_recording(experiment.holdout)
        errors = group(recording, "xyz") - tcp(experiment.model, group(recording, "q_cmd"))
        self.assertAlmostEqual(2.6e-3, study.mean_norm(errors), delta=1e-4)

    def test_motomans_models_come_within_a_millimetre(self):
        for experiment in self.experiments("motoman_ma1400"):
            recording = tables.read_recording(experiment.holdout)
            errors = group(recording, "xyz") - tcp(experiment.model, group(recording, "q_cmd"))
            self.assertLess(np.linalg.norm(errors, axis=1).max(), 1e-3)

    def test_jaibots_column_gives_and_its_base_hardly(self):
        self.experiments("hilti_jaibot")
        found = tilt.springs(pathlib.Path(DATA) / jaibot.FOLDER, "flat")
        self.assertTrue(np.all(found["top of the column"] > 15 * found["base"]))


if __name__ == "__main__":
    unittest.main()
