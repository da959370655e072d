"""The plant against closed forms and the URDF's own numbers."""

import copy
import pathlib
import sys
import unittest
import xml.etree.ElementTree as xml

import mujoco
import numpy as np
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from plant import assembly, description, sensors  # noqa: E402
from plant.effects import EFFECTS  # noqa: E402
from plant.motion import LoadTest, Motion  # noqa: E402
from plant.simulation import Simulation, simulate  # noqa: E402

ROBOTS = pathlib.Path(__file__).resolve().parents[3] / "host" / "robots"
KR270 = ROBOTS / "kr270" / "robot.yaml"
POSTURE = np.array([0.3, -1.2, 1.1, 0.4, 0.9, -0.5])


def urdf_place(q):
    """Origins and axes (6, 3) of the joints and the flange (3,), from the URDF alone."""
    place, turn, origins, axes = np.zeros(3), np.eye(3), [], []
    joints = xml.parse(KR270.with_name("kr270.urdf")).getroot().findall("joint")
    for joint in joints:
        offset = [float(value) for value in joint.find("origin").get("xyz").split()]
        angles = [float(value) for value in joint.find("origin").get("rpy").split()]
        place = place + turn @ offset
        turn = turn @ Rotation.from_euler("xyz", angles).as_matrix()
        if joint.get("type") == "revolute":
            axis = np.array([float(value) for value in joint.find("axis").get("xyz").split()])
            origins.append(place)
            axes.append(turn @ axis)
            turn = turn @ Rotation.from_rotvec(q[len(axes) - 1] * axis).as_matrix()
    return np.array(origins), np.array(axes), place


def robot(gravity=0.0):
    """A KR 270 with rotors, and a load on its flange, or its wrist would weigh next to nothing."""
    loaded = description.load(KR270)
    loaded.gravity = np.array([0, 0, -gravity])
    loaded.payload_mass, loaded.payload_center = 60.0, np.array([0.05, 0.02, 0.15])
    for joint in loaded.joints:
        joint.rotor_inertia = 3e-3 * joint.effort
    return loaded


def load_test(wrenches, q=POSTURE):
    wrenches = np.array(wrenches, float)[None]
    return LoadTest(q[None], wrenches, np.full(wrenches.shape[1], 20.0))


def sway(duration=1.6, step=assembly.STEP, size=0.06):
    """All joints to and fro, from rest to rest."""
    time = np.arange(round(duration / step)) * step
    omega = 2 * np.pi / duration
    wave = np.stack([(1 - np.cos(omega * time)) / 2, omega * np.sin(omega * time) / 2,
                     omega**2 * np.cos(omega * time) / 2])[:, :, None] * size
    grow = np.clip(time / 0.4, 0, 1)[:, None] ** 2
    wrench = grow * np.array([300, -200, 400, 10, 20, -10])
    return Motion(time, POSTURE + wave[0], wave[1] + 0 * POSTURE, wave[2] + 0 * POSTURE, wrench,
                  np.full(len(time), 20.0))


def stand_after(motion, duration):
    """The motion, and then its last posture for `duration` s."""
    rows = round(duration / assembly.STEP)
    time = np.arange(len(motion.time) + rows) * assembly.STEP
    still = np.zeros((rows, 6))
    return Motion(time, np.vstack([motion.q, still + motion.q[-1]]),
                  np.vstack([motion.velocity, still]), np.vstack([motion.acceleration, still]),
                  np.vstack([motion.wrench, still + motion.wrench[-1]]), np.full(len(time), 20.0))


class Springs(unittest.TestCase):
    def test_gives_as_the_levers_of_the_urdf_say(self):
        origins, axes, flange = urdf_place(POSTURE)
        compliance = description.load(KR270).column("compliance")
        force = np.array([400.0, -700.0, 500.0])
        levers = np.cross(axes, flange - origins)
        expected = levers.T @ (compliance * (levers @ force))
        found = simulate(robot(), [], load_test([np.zeros(6), [*force, 0, 0, 0]])).xyz
        np.testing.assert_allclose(found[0], flange, atol=1e-9)
        apart = found[1] - found[0] - expected
        self.assertLess(np.linalg.norm(apart), 0.01 * np.linalg.norm(expected))

    def test_a_load_is_at_rest_and_remembers_none_before_it(self):
        heavy = description.load(ROBOTS / "kr360" / "robot.yaml")
        heavy.gravity = np.zeros(3)
        steps = np.array([0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0])
        pull = load_test(np.outer(steps, [0, 3000, 0, 0, 0, 0]))
        found = simulate(heavy, [], pull).xyz
        for load in (0.5, 0, -0.5):
            same = found[steps == load]
            np.testing.assert_allclose(same - same[0], 0, atol=3e-6)

    def test_play_shows_between_motor_and_link(self):
        gap, joint = 3e-4, 3
        pull = [[0, 0, 900, 0, 0, 0], [0, 0, -900, 0, 0, 0]]
        tight = simulate(robot(), [], load_test(pull))
        loose = simulate(robot(), [EFFECTS["backlash"](joint, gap=gap, hold=10.0)], load_test(pull))
        more = (loose.q_link - tight.q_link)[:, joint - 1]
        self.assertAlmostEqual(gap, abs(more[1] - more[0]), delta=0.01 * gap)

    def test_a_hardening_spring_winds_up_by_its_cubic(self):
        joint, cubic = 3, -2e-14
        pull = load_test([[0, 0, 0, 0, 0, 0], [0, 0, 1500, 0, 0, 0]])
        compliance = robot().joints[joint - 1].compliance
        straight = simulate(robot(), [], pull).q_link[1, joint - 1] - POSTURE[joint - 1]
        effect = EFFECTS["nonlinear_stiffness"](joint, cubic_compliance=cubic)
        bent = simulate(robot(), [effect], pull).q_link[1, joint - 1] - POSTURE[joint - 1]
        torque = straight / compliance
        more = bent - straight
        self.assertAlmostEqual(cubic * torque**3, more, delta=0.01 * abs(more))

    def test_dry_friction_beside_the_spring_leaves_a_loop(self):
        joint, windup = 3, 1e-4
        steps = np.array([0, 1, 2, 3, 2, 1, 0, -1, -2, -3, -2, -1, 0, 1, 2, 3]) / 3
        course = load_test(np.outer(steps, [0, 0, 5000, 0, 0, 0]))
        loop = EFFECTS["hysteresis"](joint, amplitude=windup, slip=1e-4)
        found = simulate(robot(), [loop], course).q_link[:, joint - 1] - POSTURE[joint - 1]
        falling, rising = found[6], found[12]  # both at no load
        # Settling rebounds a little, so that the sliders stop below their slip.
        self.assertAlmostEqual(2 * windup, abs(falling - rising), delta=0.4 * windup)
        self.assertEqual(np.sign(falling), np.sign(found[3]))  # it lags behind the load

    def test_the_yield_torque_of_hysteresis_is_the_integral_of_what_its_lag_has_not_reached(self):
        joint, windup, slip = 3, 1e-4, 2e-4
        loop = EFFECTS["hysteresis"](joint, amplitude=windup, slip=slip)
        Simulation(robot(), [loop], POSTURE)
        stiffness = 1 / robot().joints[joint - 1].compliance
        deflection = np.linspace(0, 2 * slip, 20001)
        lag = np.mean([np.minimum(deflection / (share * slip), 1) for share in loop.SLIPS], axis=0)
        load = stiffness * (deflection + windup * lag)
        self.assertAlmostEqual(loop.parameters["yield_torque"], np.trapezoid(1 - lag, load), delta=0.01)

    def test_a_base_on_springs_moves_by_its_compliance(self):
        pull = [np.zeros(6), [0, 0, 1000, 0, 0, 0]]
        base = EFFECTS["base_compliance"](None, z=4e-8)
        found = [np.diff(simulate(robot(), effects, load_test(pull)).xyz[:, 2])[0]
                 for effects in ([], [base])]
        self.assertAlmostEqual(4e-5, found[1] - found[0], delta=4e-7)

    def test_a_spring_balancer_pulls_as_its_triangle_says(self):
        effect = EFFECTS["gravity_compensator"](2, 0.7, 0.3, 2e5, 0.35, np.pi / 2 + 0.2)
        for lean in (-1.0, 0.4, 1.1):
            q = POSTURE.copy()
            q[1] = lean - effect.parameters["zero_angle"]
            run = Simulation(robot(), [effect], q)
            run.data.qpos[run.motor] = q
            mujoco.mj_forward(run.model, run.data)
            far, near = 0.7, 0.3
            length = np.sqrt(far**2 + near**2 - 2 * far * near * np.cos(lean))
            expected = -2e5 * (length - 0.35) * far * near * np.sin(lean) / length
            self.assertAlmostEqual(expected, run.data.qfrc_spring[run.motor_dof[1]],
                                   delta=1e-6 * abs(expected))
            parts = effect.parameters
            self.assertAlmostEqual(expected, -np.sin(lean) * (
                parts["stiffness_torque"] + parts["pull_torque"] / (length / far)), delta=1e-6)


class Dynamics(unittest.TestCase):
    def test_the_hanging_arm_swings_with_its_period(self):
        """Shoulder free, all else stiff: a physical pendulum, T = 2π sqrt(I / (m g l))."""
        arm = robot(gravity=9.81)
        arm.payload_mass = 0.0
        q = np.array([0, np.pi / 2, 0, 0, 0, 0])
        links = [link for link in xml.parse(KR270.with_name("kr270.urdf")).getroot().findall("link")
                 if link.find("inertial") is not None][2:]
        origins, _, _ = urdf_place(np.zeros(6))
        inertia = moment = aside = 0.0
        for link, origin in zip(links, origins[1:]):
            entry = link.find("inertial")
            center = [float(value) for value in entry.find("origin").get("xyz").split()]
            arm_x, _, arm_z = origin + center - origins[1]
            mass = float(entry.find("mass").get("value"))
            inertia += float(entry.find("inertia").get("iyy")) + mass * (arm_x**2 + arm_z**2)
            moment, aside = moment + mass * arm_x, aside + mass * arm_z
        lever = np.hypot(moment, aside)
        model = assembly.rigid(arm)
        data = mujoco.MjData(model)
        model.dof_armature[:] = 1e9
        model.dof_armature[1] = 0
        rest = np.pi / 2 - np.arctan2(-aside, moment)
        data.qpos[:] = q
        data.qpos[1] = rest + 0.02
        crossings, before = [], 0.02
        while len(crossings) < 5:
            mujoco.mj_step(model, data)
            now = data.qpos[1] - rest
            if before > 0 >= now or before < 0 <= now:
                crossings.append(data.time)
            before = now
        found = (crossings[4] - crossings[0]) / 2
        expected = 2 * np.pi * np.sqrt(inertia / (9.81 * lever))
        self.assertAlmostEqual(expected, found, delta=2e-3 * expected)

    def test_dry_friction_shows_in_the_torque(self):
        motion, joint = sway(), 2
        tight = simulate(robot(), [], motion)
        rough = simulate(robot(), [EFFECTS["coulomb_friction"](joint, torque=150.0)], motion)
        more = (rough.tau - tight.tau)[:, joint - 1]
        moving = np.abs(motion.velocity[:, joint - 1]) > 0.05
        shown = (more * np.sign(motion.velocity[:, joint - 1]))[moving].mean()
        self.assertAlmostEqual(150.0, shown, delta=3.0)

    def test_the_motors_follow_their_command(self):
        signals = simulate(robot(gravity=9.81), [], sway())
        self.assertLess(np.abs(signals.q_meas - signals.q_cmd).max(), 3e-4)

    def test_a_late_joint_follows_as_a_first_order_lag_and_lets_vibrations_die_away(self):
        motion, joint = stand_after(sway(), 4.0), 2
        command = motion.q[:, joint - 1]
        for constant in (8e-3, 20e-3, 80e-3):
            late = EFFECTS["servo_lag"](joint, time_constant=constant)
            signals = simulate(robot(gravity=9.81), [late], motion)
            pole = np.exp(-assembly.STEP / constant)
            lag = lfilter([1 - pole], [1, -pole], command - command[0]) + command[0]
            wrong = np.abs(signals.q_meas[:, joint - 1] - lag).max()
            self.assertLess(wrong, 1.5e-4)  # rad, of a lag of 9e-4 to 9e-3
            at_first, at_last = (np.ptp(signals.tau[(motion.time > since) & (motion.time < since + 1)],
                                        axis=0)[joint - 1] for since in (1.7, 4.6))
            self.assertLess(at_last, 0.1 * at_first)

    def test_half_the_step_changes_less_than_the_noise(self):
        arm = robot(gravity=9.81)
        coarse, step = simulate(arm, [], sway()), assembly.STEP / 2
        fine = Simulation(arm, [], POSTURE, step=step).run(sway(step=step))
        noise = sensors.noise_levels(sensors.draw(np.random.default_rng(0), arm,
                                                  np.abs(coarse.tau).max(0)))
        for group, levels in noise.items():
            change = getattr(fine, group)[::2] - getattr(coarse, group)
            if group == "xyz":  # where the motors are is measured
                change = change[-1:]
            elif group == "q_link":
                change = change - (fine.q_meas[::2] - coarse.q_meas)
            self.assertTrue(np.all(np.sqrt((change**2).mean(0)) < levels), group)


class Sensors(unittest.TestCase):
    def test_a_late_clock_shifts_its_columns_only(self):
        signals = simulate(robot(), [], sway())
        late = signals.copy()
        EFFECTS["time_offset"]("tau", 0.01).sense(late, robot())
        rows = round(0.01 / assembly.STEP)
        np.testing.assert_allclose(late.tau[rows:], signals.tau[:-rows], atol=1e-6)
        np.testing.assert_array_equal(late.q_meas, signals.q_meas)

    def test_a_turned_force_sensor_turns_in_the_tool_frame(self):
        signals = simulate(robot(), [], load_test([[100, 200, 300, 1, 2, 3]]))
        turned = signals.copy()
        EFFECTS["wrench_frame"](rx=0.0, ry=0.0, rz=np.pi / 2).sense(turned, robot())
        tool = signals.tool[0]
        force, shown = tool.T @ signals.wrench[0, :3], tool.T @ turned.wrench[0, :3]
        np.testing.assert_allclose(shown, [-force[1], force[0], force[2]], atol=1e-9)

    def test_effects_leave_the_description_as_it_was(self):
        arm = robot()
        before = copy.deepcopy(arm)
        Simulation(arm, [EFFECTS["joint_stiffness"](2, compliance_change=1e-7),
                         EFFECTS["link_length"](2, length=1e-3)], POSTURE)
        np.testing.assert_array_equal(before.column("compliance"), arm.column("compliance"))
        np.testing.assert_array_equal(before.joints[2].position, arm.joints[2].position)


if __name__ == "__main__":
    unittest.main()
