"""The Python package: the core and the messages in it against the commands, the compiler and the C client."""

import json
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

BUILD = pathlib.Path(os.environ["FLEXCOMP_BUILD"])
SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
PROGRAM = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"
PACKAGE = BUILD / "python"
KR270 = SOURCE / "host" / "robots" / "kr270" / "robot.yaml"
os.environ["FLEXCOMP_PROGRAM"] = str(PROGRAM)
sys.path.insert(0, str(PACKAGE))

import can
import flexcomp
from flexcomp import commands
from flexcomp._core import Aligned, ffi, lib
from flexcomp.messages import Sender, decode


class Job(unittest.TestCase):
    """A circle of a KR 270, its table and configuration."""

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        cls.path, cls.table, cls.config = (cls.folder / name for name in ("path.csv", "t.fct", "node.toml"))
        commands.run("plan", "circle", model=KR270, center=(1.6, 0, 1.2), plane="xz", out=cls.path)
        commands.run("table", model=KR270, path=cls.path, tolerance=1e-6, out=cls.table)
        commands.run("configure", model=KR270, table=cls.table, out=cls.config)

    def refuses(self, result):
        return self.assertRaisesRegex(flexcomp.FlexcompError, result)


class Core(Job):
    def steady(self, row):
        """The correction that is left when all has settled."""
        recording = flexcomp.Recording.read(self.path)
        compensator = flexcomp.Compensator(flexcomp.Config.read(self.config), flexcomp.Table.read(self.table))
        given = recording.group("q_cmd")[row], recording.group("wrench")[row]
        for _ in range(20):
            compensator.tick(*given)
        compensator.arm()
        for _ in range(500):
            output = compensator.tick(*given)
        self.assertEqual("active", output.state_name)
        self.assertEqual([], output.remarks)
        return output

    def test_it_corrects_as_the_command_does(self):
        out = self.folder / "corrected.csv"
        commands.run("compensate", model=KR270, table=self.table, path=self.path, out=out)
        before, after = flexcomp.Recording.read(self.path), flexcomp.Recording.read(out)
        for row in (0, 100, 170):
            wanted = after.group("q_cmd")[row] - before.group("q_cmd")[row]
            self.assertGreater(abs(wanted).max(), 1e-4)
            for one, other in zip(wanted, self.steady(row).correction):
                self.assertAlmostEqual(one, other, delta=2e-6)

    def test_a_disarmed_compensator_fades_out(self):
        compensator = flexcomp.Compensator(flexcomp.Config.read(self.config), flexcomp.Table.read(self.table))
        recording = flexcomp.Recording.read(self.path)
        given = recording.group("q_cmd")[0], recording.group("wrench")[0]
        for _ in range(20):
            compensator.tick(*given)
        compensator.arm()
        for _ in range(200):
            compensator.tick(*given)
        compensator.disarm()
        for _ in range(200):
            output = compensator.tick(*given)
        self.assertEqual("off", output.state_name)
        self.assertEqual((0,) * 6, output.correction)

    def test_bad_input_is_told_in_words(self):
        compensator = flexcomp.Compensator(flexcomp.Config.read(self.config), flexcomp.Table.read(self.table))
        output = compensator.tick([0, -1, 1, 0, 0, 0], [math.nan] * 6)
        self.assertIn("wrench not finite", output.remarks)

    def test_what_are_not_six_numbers_is_refused_by_its_name(self):
        compensator = flexcomp.Compensator(flexcomp.Config.read(self.config), flexcomp.Table.read(self.table))
        q, wrench = [0, -1, 1, 0, 0, 0], [0] * 6
        for given, complaint in (((q[:5], wrench), "setpoint: expected 6 numbers, not 5"),
                                 (([*q, 0], wrench), "setpoint: expected 6 numbers, not 7"),
                                 ((q, []), "wrench: expected 6 numbers, not 0"),
                                 ((q, [0] * 7), "wrench: expected 6 numbers, not 7")):
            with self.assertRaisesRegex(ValueError, complaint):
                compensator.tick(*given)
        self.assertEqual(tuple(q), compensator.tick(q, wrench).setpoint)
        with self.assertRaisesRegex(ValueError, "joint_speed: expected 6 numbers, not 2"):
            flexcomp.Compensator(flexcomp.Config(model_hash=1, joint_speed=(1, 2)))

    def test_arming_too_early_is_refused(self):
        compensator = flexcomp.Compensator(flexcomp.Config.read(self.config), flexcomp.Table.read(self.table))
        with self.refuses("not armed: not ready"):
            compensator.arm()

    def test_a_configuration_that_cannot_be_is_refused(self):
        with self.refuses("configuration: "):
            flexcomp.Compensator(flexcomp.Config(model_hash=1, period=-1))

    def test_the_defaults_are_those_of_flexcompd(self):
        page = (SOURCE / "firmware" / "README.md").read_text()
        for name, value in vars(flexcomp.Config(model_hash=0)).items():
            if name != "model_hash":
                self.assertIn(f"| `{name.replace('_', '-')}` | `{value:g}` |", page)


class Tables(Job):
    def test_a_table_says_what_the_command_says_of_it(self):
        info = flexcomp.Table.read(self.table).info
        told = commands.verify_table(self.table, model=KR270, samples=1)
        self.assertEqual(int(told["model_hash"], 16), info.model_hash)
        self.assertEqual(self.table.stat().st_size, info.size)
        self.assertTrue(info.is_path)
        self.assertLessEqual(info.position_error, 1e-6)

    def test_a_damaged_one_is_refused_by_its_name(self):
        data = bytearray(self.table.read_bytes())
        data[500] ^= 1
        damaged = self.folder / "damaged.fct"
        damaged.write_bytes(data)
        with self.refuses("damaged.fct: "):
            flexcomp.Table.read(damaged)
        for size in (0, 3, 100):
            with self.refuses("table: "):
                flexcomp.Table(bytes(data[:size]))

    def test_a_signed_one_is_taken_without_its_signature(self):
        key, signed = self.folder / "key", self.folder / "signed.fct"
        key.touch(0o600)
        key.write_text("3a7f0c9d51e2b8460f1d2c3b4a596877\n")
        signed.write_bytes(self.table.read_bytes())
        commands.run("table", "sign", signed, key=key, counter=7)
        self.assertEqual(self.table.stat().st_size + 24, signed.stat().st_size)
        self.assertEqual(self.table.stat().st_size, flexcomp.Table.read(signed).info.size)

    def test_one_of_another_robot_is_refused(self):
        config = flexcomp.Config.read(self.config)
        config.model_hash += 1
        with self.refuses("another robot"):
            flexcomp.Compensator(config, flexcomp.Table.read(self.table))


class Layout(unittest.TestCase):
    def test_the_structures_are_laid_out_as_the_compiler_does(self):
        names = [name for name in ffi.list_types()[0] if ffi.typeof(name).kind == "struct"]
        lines = [f'printf("%zu ", sizeof({name}));' for name in names]
        lines += [f'printf("%zu ", offsetof({name}, {field}));' for name in names
                  for field, _ in ffi.typeof(name).fields]
        text = ("#include <stdio.h>\n#include <flexcomp/client.h>\nint main(void) {" + "".join(lines)
                + "return 0;}\n")
        with tempfile.TemporaryDirectory() as folder:
            source, program = pathlib.Path(folder) / "layout.c", pathlib.Path(folder) / "layout"
            source.write_text(text)
            subprocess.run([os.environ["FLEXCOMP_C"], f"-I{SOURCE}/include", source, "-o", program], check=True)
            told = [int(word) for word in subprocess.run([program], check=True, capture_output=True,
                                                         text=True).stdout.split()]
        sizes = [ffi.sizeof(name) for name in names]
        offsets = [ffi.offsetof(name, field) for name in names for field, _ in ffi.typeof(name).fields]
        self.assertIn("flexcomp_client_t", names)
        self.assertEqual(told, sizes + offsets)

    def test_objects_are_aligned_as_the_library_wants(self):
        for _ in range(20):
            self.assertEqual(0, int(ffi.cast("uintptr_t", Aligned("flexcomp_client_t").pointer)) % 64)


class Frames(unittest.TestCase):
    """Made by cantools from flexcomp.dbc, against the C client, whose codec is generated code."""

    def setUp(self):
        self.random = random.Random(7)

    def both(self, fd):
        client = Aligned("flexcomp_client_t")
        config = ffi.new("flexcomp_client_config_t *", [fd, 0x0123456789ABCDEF, [0.004, 0.05, 0.5]])
        self.assertEqual(0, lib.flexcomp_client_init(client.pointer, config))
        return client, Sender(fd)

    def assert_same(self, frames, mine):
        theirs = [(frames.frame[i].id, bytes(frames.frame[i].data)[:frames.frame[i].size].hex(), frames.frame[i].fd)
                  for i in range(frames.count)]
        self.assertEqual(theirs, [(m.arbitration_id, m.data.hex(), m.is_fd) for m in mine])

    def test_setpoints_and_wrenches_are_the_same_bit_for_bit(self):
        frames = ffi.new("flexcomp_frames_t *")
        for fd in (False, True):
            client, sender = self.both(fd)
            for i in range(300):
                q = [self.random.uniform(-6.7, 6.7) for _ in range(6)]
                wrench = [self.random.uniform(-600, 600) for _ in range(6)]
                lib.flexcomp_client_setpoint(client.pointer, q, 1000 * i, frames)
                self.assert_same(frames, sender.setpoint(q, i))
                lib.flexcomp_client_wrench(client.pointer, wrench, i % 2, 1000 * i, frames)
                self.assert_same(frames, sender.wrench(wrench, i % 2, i))

    def test_what_does_not_fit_is_not_available_in_both(self):
        frames = ffi.new("flexcomp_frames_t *")
        client, sender = self.both(False)
        q = [math.nan, 7.0, -7.0, math.inf, 0.0, 0.1]
        lib.flexcomp_client_setpoint(client.pointer, q, 0, frames)
        mine = sender.setpoint(q, 0)
        self.assert_same(frames, mine)
        self.assertTrue(math.isnan(decode(mine[0])[1]["q1"]))
        self.assertAlmostEqual(0.1, decode(mine[2])[1]["q6"], delta=1e-7)

    def test_identity_and_commands_are_the_same(self):
        frames = ffi.new("flexcomp_frames_t *")
        client, sender = self.both(False)
        lib.flexcomp_client_identity(client.pointer, frames)
        self.assert_same(frames, sender.identity(0x0123456789ABCDEF))
        for command in (1, 2, 3, 4):
            lib.flexcomp_client_command(client.pointer, command, frames)
            self.assert_same(frames, sender.command(command))

    def test_what_is_damaged_or_foreign_is_not_decoded(self):
        (frame,) = Sender(False).command(1)
        self.assertIsNotNone(decode(frame))
        for bit in range(64):
            data = bytearray(frame.data)
            data[bit // 8] ^= 1 << bit % 8
            self.assertIsNone(decode(can.Message(arbitration_id=frame.arbitration_id, data=data, is_extended_id=False)))
        self.assertIsNone(decode(can.Message(arbitration_id=0x7FE, data=bytes(8), is_extended_id=False)))
        self.assertIsNone(decode(can.Message(arbitration_id=frame.arbitration_id, data=bytes(3), is_extended_id=False)))


class Bus(unittest.TestCase):
    """A client on a bus of python-can alone, where nobody answers."""

    def setUp(self):
        self.bus, self.other = (can.Bus(interface="virtual", channel=self.id()) for _ in range(2))
        self.addCleanup(self.bus.shutdown)
        self.addCleanup(self.other.shutdown)
        self.client = flexcomp.Client(self.bus, 1, period=0.001)

    def test_what_cannot_be_followed_is_refused_before_anything_is_sent(self):
        q = [0.1] * 6
        for given, complaint in (((q[:5],), "setpoint: expected 6 numbers, not 5"),
                                 ((q, [0] * 7), "wrench: expected 6 numbers, not 7"),
                                 (([*q[:5], math.nan],), "setpoint: expected finite numbers"),
                                 (([*q[:5], math.inf],), "setpoint: expected finite numbers")):
            with self.assertRaisesRegex(ValueError, complaint):
                self.client.cycle(*given)
        self.assertIsNone(self.other.recv(0))
        self.assertEqual(tuple(q), self.client.cycle(q).drives)
        self.assertIsNotNone(self.other.recv(0))

    def test_a_command_that_is_none_is_refused_with_those_that_are(self):
        with self.assertRaisesRegex(ValueError, "one of arm, disarm, reset, report, not 'foo'"):
            self.client.request("foo")
        self.assertIsNone(self.other.recv(0))


class Words(unittest.TestCase):
    def test_whatever_is_public_says_what_it_is(self):
        silent = []
        for name in flexcomp.__all__:
            thing = getattr(flexcomp, name)
            members = vars(thing).items() if isinstance(thing, type) else ()
            silent += [f"{name}.{member}" for member, value in members if not member.startswith("_")
                       and (callable(value) or isinstance(value, (classmethod, property))) and not value.__doc__]
            silent += [] if thing.__doc__ else [name]
        self.assertEqual([], silent)


class Recordings(Job):
    def test_a_recording_is_a_frame_with_its_groups(self):
        recording = flexcomp.Recording.read(self.path)
        self.assertEqual(["q_cmd", "wrench"], list(recording.groups))
        self.assertEqual((len(recording.time), 6), recording.group("wrench").shape)
        self.assertEqual(440, recording.frame["fx"][0])

    def test_what_is_written_is_read_by_the_commands(self):
        recording = flexcomp.Recording.read(self.path)
        recording.frame.loc[3, "fx"] = math.nan
        copy = self.folder / "copy.csv"
        recording.write(copy)
        again = flexcomp.Recording.read(copy)
        self.assertTrue(math.isnan(again.frame["fx"][3]))
        commands.run("simulate", model=KR270, path=self.path, out=self.folder / "simulated.csv")
        simulated = flexcomp.Recording.read(self.folder / "simulated.csv")
        self.assertIn("position", simulated.groups)

    def test_what_is_no_recording_is_refused_by_its_name(self):
        good = self.path.read_text().splitlines()
        for text, complaint in (
                ("x,y,z\n1,2,3\n", "there is no column t"),
                ("t,x,y\n0,1,2\n", "only x, y of x, y, z"),
                ("t,q_cmd_2\n0,1\n", "q_cmd_1 to q_cmd_2 are not all there"),
                ("t,x,y,z,speed\n0,1,2,3,4\n", "unknown columns speed"),
                ("\n".join([good[0], good[2], good[1]]) + "\n", "t does not grow")):
            file = self.folder / "bad.csv"
            file.write_text(text)
            with self.assertRaisesRegex(ValueError, f"bad.csv: {complaint}"):
                flexcomp.Recording.read(file)


class Commands(Job):
    def test_a_command_returns_its_json_as_an_object(self):
        out = self.folder / "simulated.csv"
        commands.run("simulate", model=KR270, path=self.path, out=out)
        said = subprocess.run([PROGRAM, "circularity", out, "--columns", "x,z", "--json"], check=True,
                              capture_output=True, text=True).stdout
        self.assertEqual(json.loads(said), commands.circularity(out, columns=("x", "z")))

    def test_a_check_that_does_not_hold_returns_what_it_found(self):
        recording = flexcomp.Recording.read(self.path)
        recording.frame[recording.groups["q_cmd"]] *= 180 / math.pi
        recording.write(self.folder / "degrees.csv")
        found = commands.check(model=KR270, path=self.folder / "degrees.csv")["checks"]
        self.assertIn("error", {one["severity"] for one in found})

    def test_a_list_repeats_an_option(self):
        found = commands.check(model=KR270, recording=[self.path, self.path])
        self.assertIn("checks", found)

    def test_a_program_that_is_not_there_is_an_error_that_names_it(self):
        with unittest.mock.patch.dict(os.environ, {"FLEXCOMP_PROGRAM": "no-such-program"}):
            with self.assertRaisesRegex(commands.CommandError, "^no-such-program: No such file") as caught:
                commands.run("--version")
        self.assertEqual(127, caught.exception.code)

    def test_unusable_input_is_an_error_with_the_commands_own_line(self):
        with self.assertRaisesRegex(commands.CommandError, "missing.csv") as caught:
            commands.circularity(self.folder / "missing.csv")
        self.assertEqual(2, caught.exception.code)


class Wheel(unittest.TestCase):
    def test_it_is_built_installed_and_imported(self):
        with tempfile.TemporaryDirectory() as folder:
            pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check", "--no-cache-dir"]
            subprocess.run([*pip, "wheel", "--no-deps", "--no-index", "--no-build-isolation", "--wheel-dir", folder,
                            str(PACKAGE)], check=True, capture_output=True)
            (wheel,) = pathlib.Path(folder).glob("*.whl")
            self.assertRegex(wheel.name, r"^flexcomp-[0-9.]+-py3-none-linux_\w+\.whl$")
            target = pathlib.Path(folder) / "installed"
            subprocess.run([*pip, "install", "--no-deps", "--no-index", "--target", str(target), str(wheel)], check=True)
            program = ("import flexcomp; from flexcomp.messages import DATABASE;"
                       "print(flexcomp.__file__, flexcomp.version(), len(DATABASE.messages))")
            said = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True,
                                  cwd=folder, env=os.environ | {"PYTHONPATH": str(target)}).stdout.split()
        self.assertTrue(said[0].startswith(str(target)))
        self.assertEqual(flexcomp.version(), said[1])


if __name__ == "__main__":
    unittest.main()
