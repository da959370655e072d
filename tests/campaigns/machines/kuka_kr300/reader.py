"""KUKA KR 300 R2500 ultra SE: three free motions with the torques of its motors.

Geometry, masses, centres, inertias, rotors and gear ratios are the CAD numbers of
github.com/JonasWeigand/Robot_Identification, commit 9e403c0 (MIT). Torques are motor torques times
gear ratio. The model leaves out all friction, the hydraulic counterbalance of axis 2, the springs
of the gears, and the inertias of link 6 and of the payload about their own centres.
"""

import math

import numpy as np

from ..chain import Body, Chain, Joint, by_standard_parameters, tensor
from ..geometry import turned
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import read_table, stacked, write_recording

TITLE = "KUKA KR 300 R2500 ultra SE, six axes"
LEFT_OUT = "all friction, the hydraulic counterbalance of axis 2, delay of the link-side encoders"
FOLDER = "kuka_kr300"
TRAINING = ("B", "C")
HELD_OUT = "A"
FILES = [f"kr300_{motion}.csv" for motion in (*TRAINING, HELD_OUT)]

AXES = range(1, 7)
AT_REST = 10  # rows, at the begin of each recording
WITH_LINK_ENCODER = range(1, 4)
COLUMNS = (["t_s"] + [f"motor_deg_{axis}" for axis in AXES]
           + [f"linkenc_deg_{axis}" for axis in WITH_LINK_ENCODER]
           + [f"motor_torque_Nm_{axis}" for axis in AXES])

GEAR_RATIO = (1798 / 7, 1872 / 7, 757 / 3, 221, 5032 / 21, 206793 / 1340)
ROTOR_INERTIA = (0.00923, 0.0118, 0.0118, 0.00173, 0.00173, 0.00173)  # kg·m², motor side
RANGE = ((-147, 147), (-50, 85), (-202, 63), (-350, 350), (-122.5, 122.5), (-350, 350))  # degrees

# Denavit and Hartenberg's parameters a (m), d (m), alpha; the base is upside down.
LINKS = ((0.350, -0.675, math.pi / 2), (1.150, -0.189, 0.0), (0.041, 0.189, -math.pi / 2),
         (0.0, -1.0, math.pi / 2), (0.0, 0.0, -math.pi / 2), (0.0, -0.240, math.pi))
ANGLE_AT_ZERO = (0.0, -math.pi / 2, math.pi, 0.0, 0.0, 0.0)
BODIES = (  # in the frames at the links' far ends
    Body(395.4, np.array([-0.353, 0.174, -0.004]), tensor(16.73, 29.80, 32.81, -1.70, 0.129, 4.40)),
    Body(339.12, np.array([-0.709, -0.001, 0.023]), tensor(7.51, 88.89, 88.67, 0.43, 0.173, -4.40)),
    Body(105.21, np.array([-0.018, -0.018, -0.076]),
         tensor(10.78, 10.19, 1.94, 0.118, -0.606, -0.102)),
    Body(35.8, np.array([0.0, 0.236, 0.001]), tensor(0.425, 0.218, 0.428, 0.0, -0.0114, 0.0)),
    Body(31.46, np.array([0.0, -0.080, -0.009]), tensor(0.284, 0.230, 0.258, 0.0, -0.0195, 0.0)),
    Body(17.78, np.array([0.0, 0.0, -0.050])))
PAYLOAD = Body(151.0, np.array([0.0, 0.0, 0.1]))  # beyond the flange, as its owners identified it


def chain():
    places, ends = by_standard_parameters(LINKS, turned("x", math.pi), ANGLE_AT_ZERO)
    joints = [
        Joint(place, [body.seen_from(end)], math.radians(lower), math.radians(upper),
              rotor * ratio**2)
        for place, end, body, (lower, upper), rotor, ratio in zip(
            places, ends, BODIES, RANGE, ROTOR_INERTIA, GEAR_RATIO, strict=True)]
    joints[-1].bodies.append(PAYLOAD.seen_from(ends[-1]))
    return Chain("KUKA KR 300 R2500 ultra SE", joints, tool=ends[-1])


def read(path):
    """Time (n,) s, motor-side angles (n, 6) rad, link-side angles (n, 3) rad, torques (n, 6)
    N·m."""
    table = read_table(path, COLUMNS, rising="t_s")
    return (table["t_s"], np.radians(stacked(table, "motor_deg_{}", AXES)),
            np.radians(stacked(table, "linkenc_deg_{}", WITH_LINK_ENCODER)),
            stacked(table, "motor_torque_Nm_{}", AXES) * np.array(GEAR_RATIO))


def referenced(link, motor):
    """Link-side angles (n, 3) less what they differ by from the motor-side ones (n, 6) at rest.

    Every recording has other zeros, up to 2.5 mrad apart; a diagnosis has one for all of them.
    """
    difference = link - motor[:, :link.shape[1]]
    return link - difference[:AT_REST].mean(axis=0)


def write(data, folder):
    """Two experiments: the torques of all axes, and the link-side against the motor-side
    encoders."""
    model = write_robot(folder, chain())
    written = {}
    for motion in (*TRAINING, HELD_OUT):
        time, motor, link, torque = read(data / f"kr300_{motion}.csv")
        absent = np.full((len(time), 6 - link.shape[1]), np.nan)
        written["torques", motion] = write_recording(
            folder / f"torques_{motion}.csv", time, q_meas=motor, tau=torque)
        written["encoders", motion] = write_recording(
            folder / f"encoders_{motion}.csv", time, q_meas=motor,
            q_link=np.hstack([referenced(link, motor), absent]))
    return [Experiment(name, model, [written[name, motion] for motion in TRAINING],
                       written[name, HELD_OUT]) for name in ("torques", "encoders")]
