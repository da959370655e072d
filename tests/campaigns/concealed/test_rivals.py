"""The rivals: they find what they can find, and are judged on the same samples as everybody."""

import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

# Read when numpy is loaded. On matrices as small as these, threads only wait for one another.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np  # noqa: E402
import yaml  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

from rivals import black_box, contest, features, recording, refit, residual, toolbox  # noqa: E402

try:
    from rivals import boosting, gaussian_process, sindy
except ImportError as missing:
    boosting = gaussian_process = sindy = None
    WHY = f"{missing.name} is not installed"
else:
    WHY = ""

NOISE = 1e-5
JOINTS = [f"joint_a{k}" for k in range(1, 7)]
COMPLIANCE = 1e-6
LEVERS = np.array([[0.9, 0.2, 0.1, 0.05, 0.02, 0.01], [0.1, 0.8, 0.3, 0.1, 0.05, 0.02],
                   [0.2, 0.1, 0.7, 0.2, 0.1, 0.05]])  # m, a made-up arm: TCP by joint


def motion(seed, middle=0.0, rows=600, step=0.015):
    """Angles (rows, 6) rad of a smooth motion of all joints about `middle`."""
    draw = np.random.default_rng(seed)
    time = step * np.arange(rows)
    phases = np.outer(time, 0.8 + 0.35 * np.arange(6)) + draw.uniform(0, 6, 6)
    return time, middle + 0.6 * np.sin(phases)


def data(residual_of, seed, middle=0.0, components=1):
    """contest.Data of a recording whose residual is residual_of(angles, wrench) in the first
    component and else noise."""
    draw = np.random.default_rng(100 + seed)
    time, angles = motion(seed, middle)
    wrench = 300 * np.sin(np.outer(time, [1.1, 1.7, 0.9, 0.6, 2.1, 1.4]) + seed)
    measured = np.zeros((len(time), components))
    measured[:, 0] = residual_of(angles, wrench)
    measured += NOISE * draw.normal(size=measured.shape)
    read = recording.Recording(time, {"q_meas": angles, "wrench": wrench, "xyz": measured})
    return contest.Data(
        pathlib.Path(f"{seed}.csv"), read, {"tcp_position": np.zeros_like(measured)},
        {"tcp_position": measured}, {"tcp_position": np.isfinite(measured)})


def linear_law(angles, wrench):
    return 6e-7 * wrench[:, 1] - 4e-7 * wrench[:, 2]


def bending_law(angles, wrench):
    return 1.5e-4 * np.sin(2 * angles[:, 1])


def left_by(learn, law, *middles):
    """For recordings not learnt from, about other middles: (rms of the residual before, after)."""
    predict = black_box.learnt(learn, [data(law, 1), data(law, 2)], "tcp_position")
    found = []
    for middle in middles:
        other = data(law, 3, middle)
        before = other.residual["tcp_position"]
        found.append([residual.rms(values, np.isfinite(values))
                      for values in (before, before - predict(other.recording))])
    return found


@unittest.skipIf(WHY, WHY)
class BlackBoxes(unittest.TestCase):
    def test_pysindy_recovers_a_linear_law_also_elsewhere(self):
        for before, after in left_by(sindy.learn, linear_law, 0.0, 0.8):
            self.assertGreater(before, 6 * NOISE)
            self.assertLess(after, 1.2 * NOISE)

    def test_pysindy_recovers_products_of_angle_functions_and_loads(self):
        def law(q, w):
            return 2e-6 * np.sin(q[:, 1]) * w[:, 0]
        ((before, after),) = left_by(sindy.learn, law, 0.0)
        self.assertGreater(before, 10 * NOISE)
        self.assertLess(after, 2 * NOISE)

    def test_trees_and_processes_learn_where_they_were_trained_but_not_elsewhere(self):
        for learn in (boosting.learn, gaussian_process.learn):
            (before, trained), (_, elsewhere) = left_by(learn, bending_law, 0.0, 2.0)
            self.assertLess(trained, 0.5 * before, learn.__module__)
            self.assertGreater(elsewhere, 2 * trained, learn.__module__)

    def test_noise_alone_teaches_nothing(self):
        for learn in (sindy.learn, boosting.learn, gaussian_process.learn):
            ((before, after),) = left_by(learn, lambda q, w: np.zeros(len(q)), 0.0)
            self.assertLess(after, 1.1 * before, learn.__module__)

    def test_gaps_and_a_component_without_samples_do_no_harm(self):
        law = [data(linear_law, seed, components=3) for seed in (1, 2)]
        for each in law:
            each.residual["tcp_position"][::7] = np.nan
            each.residual["tcp_position"][:, 2] = np.nan
            each.usable["tcp_position"] = np.isfinite(each.residual["tcp_position"])
            each.recording.groups["wrench"][5:40] = np.nan
        predict = black_box.learnt(sindy.learn, law, "tcp_position")
        predicted = predict(data(linear_law, 3).recording)
        self.assertTrue(np.isfinite(predicted).all())
        self.assertEqual(0, np.abs(predicted[:, 2]).max())


class Arm:
    """Stands in for `flexcomp simulate`: levers, springs and joint friction."""

    def __init__(self, recordings):
        self._recordings = recordings

    def __call__(self, model, path):
        joints = yaml.safe_load(pathlib.Path(model).read_text())["joints"].values()
        read = self._recordings[path]
        load = read.groups["wrench"][:, :3] @ LEVERS
        compliance = np.array([joint["compliance"] for joint in joints])
        velocity = np.gradient(read.angles, read.time, axis=0)
        viscous, coulomb = (np.array([joint.get(key, 0.0) for joint in joints])
                            for key in refit.FRICTION)
        return {"tcp_position": (load * compliance) @ LEVERS.T,
                "joint_torque": viscous * velocity + coulomb * np.sign(velocity)}


def model(folder, name, **values):
    """A robot.yaml; values: key -> six numbers."""
    joints = {joint: {"compliance": COMPLIANCE} | {key: float(each[k])
                                                   for key, each in values.items()}
              for k, joint in enumerate(JOINTS)}
    path = folder / name
    path.write_text(yaml.safe_dump({"urdf": "arm.urdf", "joints": joints}))
    return path


class Refit(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.nominal = model(self.folder, "robot.yaml")

    def fitted(self, **values):
        """The refit of a machine that differs from the model in these values."""
        true = model(self.folder, "true.yaml", **values)
        recordings = {name: data(linear_law, seed).recording for seed, name in ((1, "a"), (2, "b"))}
        simulate, draw, trainings = Arm(recordings), np.random.default_rng(5), []
        for name, read in recordings.items():
            measured, nominal = simulate(true, name), simulate(self.nominal, name)
            for channel, noise in (("tcp_position", NOISE), ("joint_torque", 0.1)):
                measured[channel] += noise * draw.normal(size=measured[channel].shape)
            left = {channel: measured[channel] - nominal[channel] for channel in nominal}
            trainings.append(contest.Data(name, read, nominal, left, {
                channel: np.isfinite(values) for channel, values in left.items()}))
        path = refit.learn(self.nominal, trainings, simulate, self.folder)
        return refit.Model(path)

    def test_compliances_and_friction_are_found(self):
        compliance = COMPLIANCE * np.array([1.0, 1.5, 0.8, 1.0, 1.0, 1.0])
        viscous, coulomb = np.array([5.0, 0, 0, 0, 2.0, 0]), np.array([0, 8.0, 0, 0, 0, 1.0])
        found = self.fitted(compliance=compliance, viscous=viscous, coulomb=coulomb)
        np.testing.assert_allclose(found.of("compliance")[:3], compliance[:3], rtol=0.1)
        np.testing.assert_allclose(found.of("viscous"), viscous, atol=0.1)
        np.testing.assert_allclose(found.of("coulomb"), coulomb, atol=0.1)

    def test_nothing_becomes_negative(self):
        found = self.fitted(viscous=np.full(6, -3.0), coulomb=np.full(6, -2.0))
        self.assertGreaterEqual(min(found.of("viscous").min(), found.of("coulomb").min()), 0.0)

    def test_the_fitted_model_still_finds_its_urdf(self):
        text = yaml.safe_load((refit.Model(self.nominal).write(self.folder / "x.yaml")).read_text())
        self.assertEqual(str(self.folder.resolve() / "arm.urdf"), text["urdf"])


LOADED = 1  # the joint that a wrench loads in the stand-in


class Toolboxes(unittest.TestCase):
    """A stand-in for a package: it says twice the torque that it is given for the judged motion."""

    SAYS_TWICE = (
        "import argparse, csv\n"
        "parser = argparse.ArgumentParser()\n"
        "parser.add_argument('rival')\n"
        "for word in ('--model', '--holdout', '--out'): parser.add_argument(word)\n"
        "parser.add_argument('--recording', action='append')\n"
        "options = parser.parse_args()\n"
        "rows = list(csv.reader(open(options.holdout)))\n"
        "keep = [k for k, name in enumerate(rows[0]) if name == 't' or name[:4] == 'tau_']\n"
        "table = [[rows[0][k] for k in keep]]\n"
        "table += [[row[keep[0]], *(2 * float(row[k]) for k in keep[1:])] for row in rows[1:]]\n"
        "csv.writer(open(options.out, 'w')).writerows(table)\n")

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        script = self.folder / "package.py"
        script.write_text(self.SAYS_TWICE)
        python = self.folder / "python"  # drops "-W ignore -m machines.rivals"
        python.write_text(f'#!/bin/sh\nshift 4\nexec "{sys.executable}" "{script}" "$@"\n')
        python.chmod(0o755)
        asked = mock.patch.dict(os.environ, {toolbox.PYTHON: str(python)})
        asked.start()
        self.addCleanup(asked.stop)

    def recording(self, seed, wrench):
        """contest.Data with torques; a wrench's share of the nominal ones is 100 N·m at LOADED."""
        time, angles = motion(seed, rows=80)
        groups = {"q_meas": angles, "tau": np.zeros((80, 6))} | (
            {"wrench": np.zeros((80, 6))} if wrench else {})
        nominal = np.full((80, 6), 7.0)
        nominal[:, LOADED] += 100 if wrench else 0
        left = {"joint_torque": np.zeros((80, 6))}
        return contest.Data(self.folder / f"{seed}.csv", recording.Recording(time, groups),
                            {"joint_torque": nominal}, left,
                            {"joint_torque": np.ones((80, 6), bool)})

    def predicted(self, judged):
        box = toolbox.Toolbox("FIGAROH", self.folder / "robot.yaml",
                              lambda path: {"joint_torque": np.full((80, 6), 7.0)}, self.folder)
        return box.predictions([self.recording(1, wrench=False)], {"holdout": judged})["holdout"]

    def test_the_share_of_a_wrench_is_none_of_the_packages_business(self):
        said = self.predicted(self.recording(2, wrench=True))
        np.testing.assert_allclose(said[:, 0], 14.0)
        np.testing.assert_allclose(said[:, LOADED], 114.0)

    def test_rows_without_angles_have_no_prediction(self):
        judged = self.recording(2, wrench=False)
        judged.recording.groups["q_meas"][5] = np.nan
        said = self.predicted(judged)
        self.assertTrue(np.isnan(said[5]).all())
        np.testing.assert_allclose(np.delete(said, 5, axis=0), 14.0)

    def test_a_package_has_nothing_to_learn_without_torques(self):
        box = toolbox.Toolbox("FIGAROH", None, None, self.folder)
        with self.assertRaisesRegex(ValueError, "of which there are none"):
            box.predictions([data(linear_law, 1)], {})

    def test_they_compete_only_where_somebody_asks(self):
        self.assertIn("FIGAROH", contest.methods(True, True))
        del os.environ[toolbox.PYTHON]
        self.assertNotIn("FIGAROH", contest.methods(True, True))
        self.assertEqual([contest.NOMINAL], contest.methods(False, False))


class Judging(unittest.TestCase):
    def test_single_samples_far_off_are_outliers_and_steps_are_not(self):
        draw = np.random.default_rng(1)
        values = draw.normal(size=(300, 2))
        values[150:, 0] += 50.0
        values[[40, 200], 1] = 30.0
        found = np.argwhere(residual.outliers(values))
        self.assertEqual([[40, 1], [200, 1]], found.tolist())

    def test_gaps_are_no_outliers_and_hide_none(self):
        values = np.random.default_rng(2).normal(size=(200, 1))
        values[::2] = np.nan
        values[101] = 40.0
        self.assertEqual([[101, 0]], np.argwhere(residual.outliers(values)).tolist())
        self.assertEqual(99, residual.usable(values, False).sum())

    def test_poses_of_a_load_test_have_no_neighbours(self):
        values = np.zeros((50, 1))
        values[7] = 1.0
        self.assertTrue(residual.usable(values, True).all())
        self.assertTrue(recording.Recording(np.arange(50.0), {}).is_static)
        self.assertFalse(recording.Recording(np.arange(50.0) / 100, {}).is_static)

    def test_rms_is_over_all_samples_and_components(self):
        values = np.array([[3.0, 4.0], [np.nan, 0.0]])
        self.assertAlmostEqual((25 / 3) ** 0.5, residual.rms(values, np.isfinite(values)))
        self.assertIsNone(residual.rms(values, np.zeros(values.shape, bool)))

    def test_validation_takes_whole_stretches(self):
        held = features.validation_rows(np.arange(800) * features.STRETCHES // 800)
        self.assertEqual(200, held.sum())
        self.assertEqual(4, np.abs(np.diff(held.astype(int))).sum())

    def test_a_recording_is_read_with_its_gaps(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.csv"
            path.write_text("t,x,y,z\n0,1,,3\n0.5,4,5,6\n")
            read = recording.read(path)
        np.testing.assert_array_equal([[1, np.nan, 3], [4, 5, 6]], read.groups["xyz"])
        self.assertEqual(["tcp_position"], list(read.channels))

    def test_derivatives_are_those_of_a_sine(self):
        time, _ = motion(1)
        angles = np.column_stack([np.sin(3 * time)] * 6)
        table = features.table(recording.Recording(time, {"q_meas": angles}), "joint_torque")
        inner = slice(20, -20)
        np.testing.assert_allclose(table.columns["velocity"][inner, 0], 3 * np.cos(3 * time)[inner],
                                   atol=0.01)
        np.testing.assert_allclose(table.columns["acceleration"][inner, 0],
                                   -9 * np.sin(3 * time)[inner], atol=0.15)


if __name__ == "__main__":
    unittest.main()
