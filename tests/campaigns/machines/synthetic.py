"""Files of the published forms, made up, whose content is known in closed form."""

import csv
import gzip

import numpy as np
import scipy.io
import yaml


def write_csv(path, columns):
    """columns: {name: (n,)}."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows(zip(*(np.asarray(values).tolist() for values in columns.values())))


def numbered(form, values):
    """(n, k) -> {form with 1…k: (n,)}."""
    return {form.format(number): column for number, column in enumerate(values.T, 1)}


def swing(time, joints, amplitude=0.4, start=0.3):
    """Angles (n, joints) in rad, each joint at its own frequency."""
    frequency = 0.3 + 0.1 * np.arange(joints)
    return start + amplitude * np.sin(2 * np.pi * frequency * time[:, None] + np.arange(joints))


def dh(theta, length, offset, twist):
    """Denavit and Hartenberg's matrix (4, 4), written out."""
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(twist), np.sin(twist)
    return np.array([[ct, -st * ca, st * sa, length * ct], [st, ct * ca, -ct * sa, length * st],
                     [0, sa, ca, offset], [0, 0, 0, 1]])


def shift(x=0.0, y=0.0, z=0.0):
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def modified_dh(theta, length, offset, twist):
    """Craig's matrix (4, 4), written out."""
    ct, st, ca, sa = np.cos(theta), np.sin(theta), np.cos(twist), np.sin(twist)
    return np.array([[ct, -st, 0, length], [st * ca, ct * ca, -sa, -offset * sa],
                     [st * sa, ct * sa, ca, offset * ca], [0, 0, 0, 1]])


def kuka_kr300(folder, rows=120):
    """At rest for 0.1 s, then moving; link encoders 3 ms late, with a zero of 1 mrad; torques of 1
    to 6 N·m at the motors. Returns the motors' angles (rad)."""
    time = 0.004 * np.arange(rows)
    angles = swing(4 * np.maximum(time - 0.1, 0) ** 2, 6)
    late = swing(4 * np.maximum(time - 0.103, 0) ** 2, 6)[:, :3] + 1e-3
    for motion in "ABC":
        write_csv(folder / f"kr300_{motion}.csv", {
            "t_s": time, **numbered("ref_deg_{}", np.degrees(angles)),
            **numbered("motor_deg_{}", np.degrees(angles)),
            **numbered("linkenc_deg_{}", np.degrees(late)),
            **numbered("motor_torque_Nm_{}", np.tile(np.arange(1.0, 7.0), (rows, 1)))})
    return angles


TORN = 123  # ms: the Panda's sample with the angles of the one before


def franka_panda(folder):
    """A controller of 1 kHz, polled by a host whose clock jitters, that meets every tenth sample
    twice, misses every seventh, and one in part. Returns the controller's times (n,) of the samples
    met and the angles (n, 7)."""
    every = np.arange(400)
    met = every[every % 7 != 3]
    time = 1e-3 * met
    angles = swing(time, 7)
    ahead, behind = swing(time + 1e-6, 7), swing(time - 1e-6, 7)
    repeated = np.sort(np.concatenate([np.arange(len(met)), np.arange(0, len(met), 10)]))
    again = np.append(False, np.diff(repeated) == 0)
    shown = angles[repeated]
    torn = np.flatnonzero(met[repeated] == TORN)
    shown[torn] = shown[torn - 1]
    host = time[repeated] + 3e-4 * (-1.0) ** repeated + 2e-4 * again
    write_csv(folder / "panda_exciting_1kHz.csv", {
        "t_s": host, **numbered("q_rad_{}", shown),
        **numbered("dq_rads_{}", ((ahead - behind) / 2e-6)[repeated]),
        **numbered("tau_Nm_{}", np.tile(np.arange(1.0, 8.0), (len(repeated), 1)))})
    whole = met != TORN
    return time[whole], angles[whole]


TX40_LINK = """<link name="link_{number}"><inertial><mass value="3"/>
 <origin xyz="0.1 0 0.05" rpy="0 0 0.5"/>
 <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0.01" iyz="0" ixz="0"/></inertial></link>
<joint name="joint_{number}" type="revolute"><parent link="{parent}"/><child link="link_{number}"/>
 <origin xyz="0.2 0 0.1" rpy="{roll} 0 0"/><axis xyz="0 0 1"/>
 <limit lower="-3" upper="3" effort="100" velocity="5"/></joint>"""


def staubli_tx40(folder, rows=6000):
    """Motors of gear ratios 32, 32, 45, -48, 45, 32; motor 6 turns with joint 5 as well. The motors
    hold 1 to 6 N·m. Returns the joints' angles (n, 6) in rad."""
    folder.mkdir(parents=True, exist_ok=True)
    links = [TX40_LINK.format(number=number, roll=1.571 if number % 2 == 0 else 0.0,
                              parent=f"link_{number - 1}" if number > 1 else "base_link")
             for number in range(1, 7)]
    (folder / "tx40_mdh_modified.urdf").write_text(
        '<robot name="tx40"><link name="base_link"/>' + "\n".join(links) + "</robot>")
    angles = swing(np.arange(rows) / 5000.0, 6)
    turned = angles - np.array([0, -np.pi / 2, np.pi / 2, 0, 0, 0])
    motors = turned * [32, 32, 45, -48, 45, 32]
    motors[:, 5] = 32 * (turned[:, 5] + turned[:, 4])
    for name, values in (("pos_read_data", motors),
                         ("curr_data", np.tile(np.arange(1.0, 7.0), (rows, 1)))):
        with gzip.open(folder / f"{name}.csv.gz", "wt") as file:
            file.write("1,2,3,4,5,6\n")
            np.savetxt(file, values, delimiter=",", fmt="%.15g")
    return angles


def emps(folder):
    """Two runs of 4 s at 1 kHz: travel and voltage are the same slow sine, the voltage with a hum
    of 200 Hz."""
    time = 1e-3 * np.arange(4001)
    slow = np.sin(2 * np.pi * 0.8 * time)
    columns = {"t_s": time, "q_ref_m": 0.1 * slow, "q_meas_m": 0.1 * slow,
               "vir_V": 2 * slow + np.sin(2 * np.pi * 200 * time)}
    write_csv(folder / "DATA_EMPS.csv", columns)
    write_csv(folder / "DATA_EMPS_PULSES.csv", columns | {"force_pulse_N": np.zeros(len(time))})


def friction_damper(folder):
    """An inch to and fro, and 3 kip with the direction."""
    time = np.arange(0, 4, 1 / 128)
    phase = 2 * np.pi * 0.5 * time
    for run in ("0.5Hz36lbtension1", "1Hz36lbtension1", "1Hz36lbtension1.5", "0.5Hz36lbtension1.5"):
        write_csv(folder / f"{run}amplitude.csv", {
            "t_s": time, "displacement_in": np.sin(phase),
            "friction_force_kip": 3 * np.sign(np.cos(phase)), "velocity_in_s": np.cos(phase),
            "actuator1_lb": 0 * time, "actuator2_lb": 0 * time})


def _joint_states(path, joints, rate):
    """Torques of 1 N·m and up. Returns the angles (n, joints)."""
    time = np.arange(0, 4, 1 / rate)
    angles = swing(time, joints)
    write_csv(path, {"t": time, **numbered("q_meas_{}", angles),
                     **numbered("tau_{}", np.tile(np.arange(1.0, joints + 1), (len(time), 1)))})
    return angles


def unisa_ur10(folder):
    return _joint_states(folder / "ur10_exciting_trajectory.csv", 6, 125)


def unisa_panda(folder):
    return _joint_states(folder / "panda_exciting_trajectory.csv", 7, 30)


UR5_LINKS = ((0, 89.159, 90), (-425, 0, 0), (-392.25, 0, 0), (0, 109.15, 90), (0, 94.65, -90),
             (0, 82.3, 0))


def ur5_position(angles):
    """The reflector (3,) in mm by the manufacturer's table; angles (6,) in degrees."""
    matrix = np.eye(4)
    for angle, (length, offset, twist) in zip(angles, UR5_LINKS):
        matrix = matrix @ dh(np.radians(angle), length, offset, np.radians(twist))
    return (matrix @ [-0.01, 0.07, 31.0, 1])[:3]


def ur5(folder, poses=220):
    """Targets as the table has them, errors of 1, 2 and -3 mm; returns the angles of the grid
    (degrees)."""
    grid = np.degrees(swing(0.05 * np.arange(poses), 6, amplitude=1.0))
    for name, angles in (("grid", grid), ("random", grid[::11] + 5)):
        targets = np.array([ur5_position(each) for each in angles])
        count = len(angles)
        write_csv(folder / f"3D_UR5_uncalibrated_{name}_cleaned.csv", {
            "step_order": np.arange(count), **dict(zip(("x_t", "y_t", "z_t"), targets.T)),
            **{name: np.full(count, error)
               for name, error in (("x_dif", 1.0), ("y_dif", 2.0), ("z_dif", -3.0))},
            **numbered("joint_{}", angles)})
    return grid


JAIBOT = """<robot name="arm on a column">
<link name="column_base"/>
<joint name="lift" type="prismatic"><parent link="column_base"/><child link="column_top"/>
 <origin xyz="0 0 0" rpy="0 0 0"/><axis xyz="0 0 1"/>
 <mimic joint="column" multiplier="0.5" offset="0.1"/></joint>
<link name="column_top"/>
{joints}
<joint name="holder" type="fixed"><parent link="dsr_link6"/><child link="tool_link"/>
 <origin xyz="0 0 0.1" rpy="0 0 0"/></joint>
<link name="tool_link"><inertial><mass value="2"/><origin xyz="0 0 0.05"/></inertial></link>
<joint name="mirror" type="fixed"><parent link="tool_link"/><child link="prism"/>
 <origin xyz="0.02 0 0.03" rpy="0 0 0"/></joint>
<link name="prism"/>
</robot>
"""
JAIBOT_JOINT = """<joint name="dsr_joint{number}" type="revolute"><parent link="{parent}"/>
 <child link="dsr_link{number}"/><origin xyz="0.3 0 0.2" rpy="{roll} 0 0"/>
 <axis xyz="0 0 1"/></joint>
<link name="dsr_link{number}">
 <inertial><mass value="10"/><origin xyz="0.1 0 0"/></inertial></link>"""
JAIBOT_HEIGHT = 3.87


def jaibot_frames(angles):
    """The six links' matrices and the prism's (4, 4), seen from the column's foot."""
    found, matrix = [], shift(z=0.5 * JAIBOT_HEIGHT + 0.1)
    for number, angle in enumerate(angles):
        twist = np.pi / 2 if number % 2 else -np.pi / 2
        matrix = matrix @ shift(z=0.2) @ modified_dh(angle, 0.3, 0, twist)
        found.append(matrix)
    return [*found, matrix @ shift(0.02, 0, 0.13)]


def jaibot_moment(angles):
    """Moment (3,) of the arm's weights about the foot, N·m."""
    frames = jaibot_frames(angles)
    loads = [(10, frame @ [0.1, 0, 0, 1]) for frame in frames[:6]]
    loads.append((2, frames[5] @ [0, 0, 0.15, 1]))
    return sum(np.cross(point[:3], [0, 0, -9.81 * mass]) for mass, point in loads)


def hilti_jaibot(folder, spring=2e-5, poses=24):
    """A rigid arm seen from a station elsewhere; sensors that turn by a spring under its weight
    (the base's by a tenth of that). Returns the arm's angles (n, 6)."""
    folder.mkdir(parents=True, exist_ok=True)
    joints = [JAIBOT_JOINT.format(number=number, roll=1.571 if number % 2 == 0 else -1.571,
                                  parent=f"dsr_link{number - 1}" if number > 1 else "column_top")
              for number in range(1, 7)]
    (folder / "trailblazer.urdf").write_text(JAIBOT.format(joints="\n".join(joints)))
    arm = swing(0.2 * np.arange(poses), 6, amplitude=0.8)
    station = dh(0.7, 3.0, 1.0, 0.0)
    measurements = []
    for number, angles in enumerate(arm):
        prism = station @ np.append(jaibot_frames(angles)[-1][:3, 3], 1)
        turn = spring * jaibot_moment(angles)
        forces = {name: [float(-share * turn[1] * 9.81), float(share * turn[0] * 9.81), 9.81]
                  for name, share in (("tilt_sensor_base_accel", 0.1),
                                      ("tilt_sensor_column_accel", 1.0))}
        measurements.append({
            "id": number, "joint_states": [JAIBOT_HEIGHT, *angles.tolist()],
            "prism_position": prism[:3].tolist(), **forces})
    branches = {
        0: {"stationing_measurements": None, "evaluation_measurements": measurements[:2]},
        7: {"stationing_measurements": measurements[:4],
            "evaluation_measurements": measurements[4:]}}
    document = {"column_heights": {JAIBOT_HEIGHT: {"solution_spaces": branches}}}
    for site in ("flat", "pallet"):
        (folder / f"{site}.yaml").write_text(yaml.safe_dump(document))
    return arm


MA1400_LINKS = ((0, -0.263, 15, -90), (0.150, 1.4159, -90, 0), (0.614, 0, 180, -90), (0.200, 0, -90, 0),
                (0, -0.640, 90, 0), (0.030, 0, 90, -90), (0, 0.200, 0, 0))


def ma1400_reflector(turntable, angles, arm):
    """Where an arm's reflector is (3,), m, by the toolbox's table: a, d, alpha, angle at zero."""
    matrix, side = np.eye(4), 1 if arm == "right" else -1
    for number, (angle, (length, offset, twist, zero)) in enumerate(zip((turntable, *angles), MA1400_LINKS)):
        twist *= side if number == 0 else 1
        matrix = matrix @ dh(angle + np.radians(zero), length, offset, np.radians(twist))
    last = dh(-0.38, 0.045, 0.245, 0) if arm == "right" else dh(0, 0.050, 0.250, 0)
    return (matrix @ last)[:3, 3]


def motoman_ma1400(folder, poses=24):
    """A rigid arm seen from a tracker elsewhere. A row a marker, one to three of them a pose; the fifth pose was not
    seen. Returns the angles (n, 6) of the poses that were, of both arms alike."""
    folder.mkdir(parents=True, exist_ok=True)
    angles, turntable = swing(0.3 * np.arange(poses), 6, amplitude=0.6), 0.02
    tracker = dh(0.7, 3.0, 1.0, 0.0)
    for arm, columns in (("right", slice(7, 13)), ("left", slice(13, 19))):
        rows = []
        for number, pose in enumerate(angles):
            row = np.zeros(26)
            row[[0, 6]], row[columns] = (10 * number, turntable), pose
            row[19:22] = (tracker @ [*ma1400_reflector(turntable, pose, arm), 1])[:3] if number != 4 else np.nan
            rows += [row] * (1 + number % 3)
        scipy.io.savemat(folder / f"leica_{arm}_hand_6x6x6_dataset.mat", {"dataset": np.array(rows)},
                         do_compression=True)
    return np.delete(angles, 4, axis=0)


TIAGO_LINK = """<link name="{link}"><inertial><mass value="{mass}"/><origin xyz="0.1 0 0.05" rpy="0 0 0.5"/>
 <inertia ixx="0.1" iyy="0.2" izz="0.25" ixy="0.01" iyz="0" ixz="0"/></inertial></link>
<joint name="{joint}_joint" type="{kind}"><parent link="{parent}"/><child link="{link}"/>
 <origin xyz="0.2 0 0.1" rpy="{roll} 0 0"/><axis xyz="0 0 1"/>
 <limit lower="-3" upper="3" effort="100" velocity="5"/></joint>"""
TIAGO_FINGER = 0.063  # kg


def pal_tiago(folder):
    """Currents of 1 to 8 A. On the last link a finger slides. Returns the angles (n, 8) while it
    moves."""
    chain = [("torso_fixed_link", "torso_lift", "prismatic")]
    chain += [("torso_lift_link" if number == 1 else f"arm_{number - 1}_link", f"arm_{number}", "revolute")
              for number in range(1, 8)]
    links = [TIAGO_LINK.format(parent=parent, joint=joint, link=f"{joint}_link", kind=kind, mass=2,
                               roll=1.571 if number % 2 else 0)
             for number, (parent, joint, kind) in enumerate(chain)]
    finger = TIAGO_LINK.format(parent="arm_7_link", joint="finger", link="finger_link", kind="prismatic",
                               mass=TIAGO_FINGER, roll=0)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "tiago_48_schunk.urdf").write_text(
        '<robot name="tiago"><link name="torso_fixed_link"/>' + "\n".join([*links, finger]) + "</robot>")
    time = 0.05 * np.arange(1500)
    angles = swing(0.2 * time, 8)
    for kind, values in (("position", angles), ("effort", np.tile(np.arange(1.0, 9.0), (len(time), 1)))):
        write_csv(folder / f"tiago_{kind}.csv", {"t": time, **{
            f"- {joint}_joint_{kind}": column for (_, joint, _), column in zip(chain, values.T)}})
    return angles[(time >= 9.2) & (time <= 67.9)]
