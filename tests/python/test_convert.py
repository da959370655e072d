"""Foreign recordings, written by the packages of those who made the formats."""

import contextlib
import importlib.util
import io
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PACKAGE = pathlib.Path(os.environ["FLEXCOMP_BUILD"]) / "python"
os.environ["FLEXCOMP_PROGRAM"] = str(pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp")
sys.path.insert(0, str(PACKAGE))

import flexcomp
from flexcomp import convert

START = 1_700_000_000_123_456_789  # ns since the epoch
MILLISECOND = 1_000_000
ARM = ("shoulder", "elbow")
JOINT_STATE = """std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""
WRENCH = """std_msgs/Header header
geometry_msgs/Wrench wrench
================================================================================
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
""" + JOINT_STATE[JOINT_STATE.index("=" * 80):]


def needs(*modules):
    lacking = [module for module in modules if importlib.util.find_spec(module) is None]
    return unittest.skipIf(lacking, f"not installed: {', '.join(lacking)}")


def stamp(after):
    """`after`: ms."""
    nanoseconds = START + after * MILLISECOND
    return {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}


def header(after, frame=""):
    return {"stamp": stamp(after), "frame_id": frame}


def angle(after):
    return 0.1 + 2e-3 * after


def state(after, names=("elbow", "gripper", "shoulder"), **more):
    """The elbow stands at twice the shoulder's angle; its drive gives 20 N·m, the shoulder's 10."""
    position = {"elbow": 2 * angle(after), "gripper": 9.0, "shoulder": angle(after)}
    effort = {"elbow": 20.0, "gripper": 1.0, "shoulder": 10.0}
    return {"header": header(after), "name": list(names), "position": [position[name] for name in names],
            "velocity": [], "effort": [effort[name] for name in names]} | more


def wrench(after):
    force = {"x": float(after), "y": 2.0, "z": 3.0}
    return {"header": header(after, "tool0"), "wrench": {"force": force, "torque": {"x": 4.0, "y": 5.0, "z": 6.0}}}


class Conversion(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        self.out = self.folder / "out.csv"

    def run_main(self, *words):
        """Exit code, and both streams' texts."""
        said, complained = io.StringIO(), io.StringIO()
        before, sys.argv = sys.argv, ["convert", *map(str, words), "--out", str(self.out)]
        try:
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
                code = convert.main()
        finally:
            sys.argv = before
        return code, said.getvalue(), complained.getvalue()

    def converted(self, *words):
        code, self.said, complained = self.run_main(*words)
        self.assertEqual((0, ""), (code, complained))
        return flexcomp.Recording.read(self.out)

    def assert_refused(self, *words, saying):
        code, said, complained = self.run_main(*words)
        self.assertEqual((2, ""), (code, said))
        self.assertEqual(1, complained.count("\n"), complained)
        self.assertIn(saying, complained)
        self.assertFalse(self.out.exists())

    def assert_close(self, wanted, found):
        self.assertEqual(len(wanted), len(found))
        for one, other in zip(wanted, found):
            self.assertAlmostEqual(one, other, delta=1e-9)


@needs("mcap", "mcap_ros2")
class Mcap(Conversion):
    def write(self, *messages):
        """messages: (topic, ms after the start, content)."""
        from mcap_ros2.writer import Writer
        file = self.folder / "run.mcap"
        with file.open("wb") as stream, Writer(stream) as writer:
            schemas = {"/js": writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE),
                       "/ft": writer.register_msgdef("geometry_msgs/msg/WrenchStamped", WRENCH)}
            for topic, after, content in messages:
                writer.write_message(topic, schemas[topic], content, log_time=START + after * MILLISECOND)
        return file

    def states(self, *afters):
        return [("/js", after, state(after)) for after in afters]

    def test_joints_are_taken_by_name_from_base_to_tip(self):
        recording = self.converted(self.write(*self.states(0, 2, 4)), "--joints", ",".join(ARM))
        self.assertEqual(["q_meas", "tau"], list(recording.groups))
        self.assert_close([0, 0.002, 0.004], recording.time)
        self.assert_close([angle(2), 2 * angle(2)], recording.group("q_meas")[1])
        self.assert_close([10, 20], recording.group("tau")[1])

    def test_a_wrench_is_interpolated_to_the_rows(self):
        file = self.write(*self.states(0, 2, 4, 6), *(("/ft", after, wrench(after)) for after in (1, 3, 5)))
        rows = self.converted(file, "--joints", ",".join(ARM), "--wrench", "/ft").group("wrench")
        self.assertTrue(all(map(math.isnan, rows[0])))
        self.assert_close([2, 2, 3, 4, 5, 6], rows[1])
        self.assert_close([4, 2, 3, 4, 5, 6], rows[2])
        self.assertTrue(all(map(math.isnan, rows[3])))
        self.assertIn("/ft is in frame 'tool0'", self.said)

    def test_a_slow_wrench_fills_the_nearest_rows_only(self):
        file = self.write(*self.states(*range(0, 21, 2)), *(("/ft", after, wrench(after)) for after in (0, 9, 19)))
        rows = self.converted(file, "--joints", ",".join(ARM), "--wrench", "/ft").group("wrench")
        self.assertEqual([0, 4, 9], [row for row in range(len(rows)) if not math.isnan(rows[row][0])])
        self.assertAlmostEqual(8, rows[4][0], delta=1e-9)

    def test_a_gap_of_a_topic_stays_missing(self):
        forces = [("/ft", after, wrench(after)) for after in (*range(0, 11, 2), 30, 32, 40)]
        file = self.write(*self.states(*range(0, 41, 2)), *forces)
        rows = self.converted(file, "--joints", ",".join(ARM), "--wrench", "/ft").group("wrench")
        self.assertFalse(math.isnan(rows[5][0]))
        self.assertTrue(all(math.isnan(row[0]) for row in rows[6:15]))
        self.assertFalse(math.isnan(rows[15][0]))

    def test_states_of_other_joints_and_repeated_times_are_left_out_and_told(self):
        gripper = ("/js", 1, state(1, names=("gripper",)))
        recording = self.converted(self.write(*self.states(0, 2, 2, 4), gripper), "--joints", ",".join(ARM))
        self.assertEqual(3, len(recording.time))
        self.assertIn("2 joint states left out", self.said)

    def test_states_without_efforts_have_no_torques(self):
        file = self.write(("/js", 0, state(0, effort=[])), ("/js", 2, state(2, effort=[])))
        self.assertEqual(["q_meas"], list(self.converted(file, "--joints", "shoulder").groups))

    def test_states_without_a_stamp_have_their_time_of_arrival(self):
        unstamped = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
        file = self.write(*(("/js", t, state(t, header=unstamped)) for t in (0, 7)))
        self.assert_close([0, 0.007], self.converted(file, "--joints", "shoulder").time)

    def test_commands_are_another_topic(self):
        file = self.write(*self.states(0, 2))
        recording = self.converted(file, "--joints", ",".join(ARM), "--commands", "/js")
        self.assert_close(recording.group("q_meas")[1], recording.group("q_cmd")[1])

    def test_what_cannot_be_chosen_is_asked_for(self):
        file = self.write(*self.states(0, 2))
        self.assert_refused(file, saying="Say --joints; there are elbow, gripper, shoulder")
        self.assert_refused(file, "--joints", "wrist", saying="there is no joint 'wrist'; there are elbow, gripper")
        self.assert_refused(file, "--joints", "elbow", "--wrench", "/js", saying="'/js' is sensor_msgs/msg/JointState; "
                            "--wrench expects geometry_msgs/msg/WrenchStamped")
        self.assert_refused(file, "--joints", "elbow", "--wrench", "/w", saying="there is no topic '/w'")
        self.assert_refused(self.write(("/ft", 0, wrench(0))), "--joints", "elbow", saying="which topic has the joint "
                            "states? Say --joint-states; there are /ft (geometry_msgs/msg/WrenchStamped)")

    def test_a_damaged_file_is_refused_by_its_name(self):
        file = self.write(*self.states(*range(0, 100, 2)))
        content = file.read_bytes()
        for damaged in (content[:len(content) // 2], b"no mcap", content[:-200] + bytes(200)):
            file.write_bytes(damaged)
            self.assert_refused(file, "--joints", "elbow", saying="run.mcap: ")


@needs("rosbags")
class Bag(Conversion):
    def write(self, storage=None):
        from rosbags.rosbag2 import StoragePlugin, Writer
        from rosbags.typesys import Stores, get_typestore
        store = get_typestore(Stores.ROS2_HUMBLE)
        kinds = store.types
        folder = self.folder / "bag"
        plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
        with Writer(folder, version=9, storage_plugin=plugin) as writer:
            joints = writer.add_connection("/js", "sensor_msgs/msg/JointState", typestore=store)
            forces = writer.add_connection("/ft", "geometry_msgs/msg/WrenchStamped", typestore=store)
            for after in (0, 2, 4):
                for connection, content in ((joints, state(after)), (forces, wrench(after))):
                    message = _message(kinds, connection.msgtype, content)
                    writer.write(connection, START + after * MILLISECOND,
                                 store.serialize_cdr(message, connection.msgtype))
        return folder

    def test_bags_of_both_kinds_are_read(self):
        for storage in ("sqlite", "mcap"):
            with self.subTest(storage=storage):
                self.folder = self.folder / storage
                self.folder.mkdir()
                folder = self.write(storage)
                recording = self.converted(folder, "--joints", ",".join(ARM), "--wrench", "/ft")
                self.assert_close([0, 0.002, 0.004], recording.time)
                self.assert_close([angle(4), 2 * angle(4)], recording.group("q_meas")[2])
                self.assert_close([4, 2, 3, 4, 5, 6], recording.group("wrench")[2])

    def test_a_file_of_a_bag_stands_for_the_bag(self):
        (file,) = self.write().glob("*.db3")
        self.assertEqual(3, len(self.converted(file, "--joints", "elbow").time))

    def test_a_file_is_read_without_the_rest_of_its_bag(self):
        for storage, ending in (("sqlite", "db3"), ("mcap", "mcap")):
            with self.subTest(storage=storage):
                self.folder = self.folder / storage
                self.folder.mkdir()
                (file,) = self.write(storage).glob(f"*.{ending}")
                (file.parent / "metadata.yaml").unlink()
                recording = self.converted(file, "--joints", ",".join(ARM), "--wrench", "/ft")
                self.assert_close([angle(4), 2 * angle(4)], recording.group("q_meas")[2])
                self.assert_close([4, 2, 3, 4, 5, 6], recording.group("wrench")[2])

    def test_a_damaged_file_is_refused_by_its_name(self):
        (file,) = self.write().glob("*.db3")
        (file.parent / "metadata.yaml").unlink()
        content = file.read_bytes()
        for damaged in (content[:len(content) // 2], b"no bag"):
            file.write_bytes(damaged)
            self.assert_refused(file, "--joints", "elbow", saying=f"{file.name}: ")

    def test_a_folder_that_is_no_bag_is_refused(self):
        self.assert_refused(self.folder, "--joints", "elbow", saying=str(self.folder))


def _message(kinds, kind, content):
    """A message of rosbags from nested dicts."""
    import numpy
    made = {}
    for name, value in content.items():
        if isinstance(value, dict):
            parts = {"header": "std_msgs/msg/Header", "stamp": "builtin_interfaces/msg/Time",
                     "wrench": "geometry_msgs/msg/Wrench", "force": "geometry_msgs/msg/Vector3",
                     "torque": "geometry_msgs/msg/Vector3"}
            value = _message(kinds, parts[name], value)
        elif name in ("position", "velocity", "effort"):
            value = numpy.array(value, dtype=float)
        made[name] = value
    return kinds[kind](**made)


@needs("pyarrow")
class Parquet(Conversion):
    """As LeRobot lays its episodes out."""

    def write(self, episodes=1):
        import pyarrow
        import pyarrow.parquet
        rows = [(episode, frame) for episode in range(episodes) for frame in range(4)]
        table = pyarrow.table({
            "observation.state": pyarrow.array([[10.0 * f, 20.0 * f + e] for e, f in rows],
                                               pyarrow.list_(pyarrow.float32(), 2)),
            "action": pyarrow.array([[10.0 * f, 20.0 * f] for _, f in rows], pyarrow.list_(pyarrow.float32())),
            "timestamp": pyarrow.array([f / 30 for _, f in rows], pyarrow.float32()),
            "task": [None if f else "weld" for _, f in rows],
            "episode_index": [e for e, _ in rows]})
        file = self.folder / "episode_000000.parquet"
        pyarrow.parquet.write_table(table, file)
        return file

    RULES = ("--map", "t=timestamp", "--map", "q_meas_*=observation.state[*]:deg", "--map", "q_cmd_*=action[*]:deg")

    def test_an_episode_becomes_a_recording_by_rules(self):
        recording = self.converted(self.write(), *self.RULES)
        self.assert_close([0, math.radians(10), math.radians(20), math.radians(30)], recording.group("q_meas")[:, 0])
        self.assertAlmostEqual(math.radians(60), recording.group("q_cmd")[3, 1])
        self.assertAlmostEqual(0.1, recording.time[3], delta=1e-6)

    def test_one_of_several_episodes_has_to_be_chosen(self):
        file = self.write(episodes=3)
        self.assert_refused(file, *self.RULES, saying="which episode? Say --episode, from 0 to 2")
        self.assert_refused(file, *self.RULES, "--episode", "7", saying="has no episode 7; expected 0 to 2")
        recording = self.converted(file, *self.RULES, "--episode", "2")
        self.assertAlmostEqual(math.radians(22), recording.group("q_meas")[1, 1])

    def test_what_cannot_be_followed_is_told(self):
        file = self.write()
        self.assert_refused(file, saying="Say it with --map; it has observation.state[0], observation.state[1]")
        self.assert_refused(file, "--map", "t=time", saying="has no column 'time'")
        file.write_bytes(b"PAR1 no table PAR1")
        self.assert_refused(file, *self.RULES, saying="episode_000000.parquet: ")


class Anywhere(Conversion):
    def test_a_file_that_is_not_there_is_told(self):
        for name in ("none.mcap", "none.parquet", "none"):
            self.assert_refused(self.folder / name, "--joints", "a", saying=name)

    def test_the_command_says_who_reads_what_it_does_not(self):
        for name in ("a.mcap", "a.db3", "a.bag", "a.parquet"):
            done = subprocess.run([os.environ["FLEXCOMP_PROGRAM"], "convert", name, "--out", self.out], text=True,
                                  capture_output=True)
            self.assertEqual(2, done.returncode)
            self.assertIn(f"python3 -m flexcomp.convert {name}", done.stderr)


if __name__ == "__main__":
    unittest.main()
