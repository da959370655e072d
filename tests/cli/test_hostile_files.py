"""Files and arguments that mislead: each ends in one printable line and exit code 2."""

import os
import re
import shutil
import socket
import subprocess
import unittest

from command import FLEXCOMP, KR270, ROBOTS, Command

FLEXCOMPD = FLEXCOMP.parent / "flexcompd"
SECONDS = 20
SOME_MEMORY = 1 << 30


def run_limited(program, *arguments):
    """With as much address space as a small machine has, and for a short while."""
    shell = f'ulimit -v {SOME_MEMORY >> 10}; exec "$0" "$@"'
    limited = [] if os.environ.get("FLEXCOMP_SANITIZED") == "ON" else ["bash", "-c", shell]
    return subprocess.run([*limited, str(program), *(str(argument) for argument in arguments)],
                          capture_output=True, timeout=SECONDS, stdin=subprocess.DEVNULL)


class HostileFiles(Command):
    def assert_one_printable_line(self, done):
        text = done.stderr.decode()  # which is UTF-8
        self.assertEqual(2, done.returncode, text)
        self.assertEqual(b"", done.stdout)
        self.assertRegex(text, r"\A[^\n]+\n\Z")
        self.assertIsNone(re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028-\u202e]", text), repr(text))
        return text

    def refusal(self, program, *arguments):
        return self.assert_one_printable_line(run_limited(program, *arguments))

    def test_what_cannot_stand_in_a_configuration_is_refused_with_its_line(self):
        lines = {'nmae = 3': "nmae is no option", 'help = true': "help is no option", 'config = "x"': "config is no option",
                 'period = -1': "--period: expected a number above zero, not -1",
                 'period = abc': "--period: expected a number above zero, not abc",
                 'gain = 2': "--gain: expected a number from 0 to 1, not 2",
                 'filter-cutoff = -1': "--filter-cutoff: expected a number of zero or above",
                 'joint-speed = [1, 2, 3]': "--joint-speed: expected one number, or six",
                 'trigger = "x"': "--trigger: x not in", 'fd = maybe': "Could not convert: --fd = maybe",
                 'hold-time = 0.2': "hold-time stands in line 2 already",
                 'period = 400': "--period: 400 is out of range",
                 'ready-ticks = 1.5': "Could not convert: --ready-ticks = 1.5",
                 '[section]': "expected name = value", '= 3': "expected name = value",
                 'model-hash = "12"': "--model-hash: expected 16 hexadecimal digits"}
        for line, saying in lines.items():
            with self.subTest(line=line):
                the_rest = "" if "model-hash" in line else 'model-hash = "0123456789abcdef"\n'
                config = self.file("node.toml", f'# A node.\nhold-time = 0.1\n\n{line}\n{the_rest}')
                told = self.refusal(FLEXCOMPD, "--config", config, "--can", "vcan0")
                self.assertIn(f"flexcompd: {config}:4: {saying}", told)

    def planned(self):
        path = self.folder / "path.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--plane", "xz",
                      "--points", "60", "--out", path)
        return path

    def robot(self, name="robot", **edits):
        folder = self.folder / name
        shutil.copytree(ROBOTS / "kr270", folder)
        for file, (old, new) in edits.items():
            file = folder / {"yaml": "robot.yaml", "urdf": "kr270.urdf"}[file]
            text = file.read_text()
            self.assertIn(old, text)
            file.write_text(text.replace(old, new, 1))
        return folder / "robot.yaml"


class Escapes(HostileFiles):
    ESCAPE = "\x1b]0;owned\x07\x1b[2J\x9b31m\u202egnp"

    def test_an_escape_sequence_in_any_file_or_argument_never_reaches_the_terminal(self):
        escape = self.ESCAPE
        toml = self.file("esc.toml", f'model-hash = "0092596dd2483751"\n{escape}%n = 1\n')
        csv = self.file("esc.csv", f"t,x,{escape}\n0,1,2\n")
        cell = self.file("cell.csv", f"x,y\n0,{escape}\n")
        yaml = self.file("esc.yaml", f"schema: flexcomp/robot/1\n\"{escape}\": 1\n".replace("\x07", ""))
        urdf = self.robot("u", urdf=('link name="base_link"', f'link name="{escape}"'))
        name = self.robot("n", yaml=("name: KUKA", 'name: "\\e[2J'), urdf=("KUKA", "KUKA"))
        for program, *arguments in (
                (FLEXCOMPD, "--config", toml, "--can", "vcan0"),
                (FLEXCOMPD, "--config", f"no{escape}.toml"),
                (FLEXCOMPD, f"--{escape}"),
                (FLEXCOMPD, "--can", "vcan0", "--model-hash", escape),
                (FLEXCOMPD, "--can", "vcan0", "--model-hash", "0" * 16, "--trigger", escape),
                (FLEXCOMPD, "--can", f"v{escape}", "--model-hash", "0" * 16),
                (FLEXCOMP, escape),
                (FLEXCOMP, "circularity", f"no{escape}.csv"),
                (FLEXCOMP, "circularity", csv),
                (FLEXCOMP, "circularity", cell),
                (FLEXCOMP, "simulate", "--model", KR270, "--path", csv, "--out", "x"),
                (FLEXCOMP, "simulate", "--model", yaml, "--path", csv, "--out", "x"),
                (FLEXCOMP, "simulate", "--model", urdf, "--path", csv, "--out", "x"),
                (FLEXCOMP, "simulate", "--model", name, "--path", csv, "--out", "x"),
                (FLEXCOMP, "map", "--model", KR270, "--preset", escape, "--out", "x")):
            with self.subTest(program=program.name, arguments=arguments):
                self.refusal(program, *arguments)


class Devices(HostileFiles):
    def hostile(self):
        huge = self.folder / "huge"
        huge.touch()
        os.truncate(huge, 1 << 42)
        local = self.folder / "socket"
        listening = socket.socket(socket.AF_UNIX)
        self.addCleanup(listening.close)
        listening.bind(str(local))
        return ["/dev/zero", "/dev/null", "/dev/urandom", huge, local, self.folder, "/proc/self/mem"]

    def test_no_device_and_no_endless_file_is_read_by_flexcomp(self):
        path = self.planned()
        out = self.folder / "out"
        hostile = self.hostile()
        before = sorted(self.folder.iterdir())
        for file in hostile:
            for arguments in (["circularity", file],
                              ["form", "straightness", file],
                              ["table", "--model", KR270, "--path", file, "--out", out],
                              ["table", "verify", file, "--model", KR270],
                              ["compensate", "--model", KR270, "--table", file, "--path", path,
                               "--out", out],
                              ["simulate", "--model", file, "--path", path, "--out", out],
                              ["simulate", "--model", KR270, "--path", file, "--out", out],
                              ["diagnose", "--model", KR270, "--recording", file, "--out", out],
                              ["identify", "--model", KR270, "--recording", file],
                              ["configure", "--model", KR270, "--table", file, "--out", out],
                              ["convert", file, "--out", self.folder / "out.csv"],
                              ["node", "send-table", file, "--bus", "can:vcan0"],
                              ["plant", "--model", KR270, "--path", file, "--table", file]):
                with self.subTest(file=str(file), command=arguments[0]):
                    self.assertIn(str(file), self.refusal(FLEXCOMP, *arguments))
                    self.assertEqual(before, sorted(self.folder.iterdir()))


    def test_no_device_and_no_endless_file_is_read_by_flexcompd(self):
        model_hash = "0" * 16
        common = ("--can", "vcan0", "--model-hash", model_hash)
        for file in [*self.hostile(), self.folder / "none"]:
            for arguments in (["--config", file, "--can", "vcan0"],
                              ["--table", file, "--lcm", "udpm://239.255.76.67:7667?ttl=0",
                               "--model-hash", model_hash],
                              ["--key", file, *common]):
                with self.subTest(file=str(file), option=arguments[0]):
                    told = self.refusal(FLEXCOMPD, *arguments)
                    if arguments[0] != "--key":  # its test is tests/linux/test_key_file.cpp
                        self.assertIn(str(file), told)


class Degrees(HostileFiles):
    def test_joint_angles_in_degrees_are_refused_with_their_unit_by_every_command_that_reads_them(self):
        path = self.planned()
        header, *rows = path.read_text().splitlines()
        names = header.split(",")
        turned = [header]
        for row in rows:
            cells = row.split(",")
            turned.append(",".join(
                repr(57.29577951308232 * float(cell)) if name.startswith("q_") else cell
                for name, cell in zip(names, cells)))
        degrees = self.file("degrees.csv", "\n".join(turned) + "\n")
        load_test = self.file("load.csv", degrees.read_text().replace("q_cmd", "q_meas"))
        table = self.folder / "t.fct"
        self.run_well("table", "--model", KR270, "--path", path, "--out", table)
        out = self.folder / "out"
        for arguments in (["table", "--path", degrees, "--out", out],
                          ["table", "verify", table, "--path", degrees],
                          ["compensate", "--table", table, "--path", degrees, "--out", out],
                          ["simulate", "--path", degrees, "--out", out],
                          ["place", "--path", degrees, "--out", out],
                          ["force", "--path", degrees, "--out", out, "--diameter", "0.016", "--teeth",
                           "4", "--depth", "3e-3", "--feed-per-tooth", "8e-5", "--shear", "7e8,2e8,1e8"],
                          ["identify", "--recording", load_test, "--out", out]):
            with self.subTest(arguments[0]):
                text = self.refusal(FLEXCOMP, *arguments, "--model", KR270)
                self.assertRegex(text, r"csv:2: column 'q_(cmd|meas)_\d': -?\d+\.?\d* rad lies outside the "
                                       r"joint's limits, \S+ to \S+ rad; expected radians: are these degrees\?")
                self.assertFalse(out.exists())

    def test_a_program_a_little_outside_the_limits_is_refused_before_a_table_is_made(self):
        path = self.planned()
        text = path.read_text().splitlines()
        names = text[0].split(",")
        cells = text[5].split(",")
        cells[names.index("q_cmd_3")] = "2.71"
        text[5] = ",".join(cells)
        outside = self.file("outside.csv", "\n".join(text) + "\n")
        told = self.refusal(FLEXCOMP, "table", "--model", KR270, "--path", outside, "--out",
                            self.folder / "t.fct")
        self.assertIn("outside.csv:6: column 'q_cmd_3': 2.71 rad lies outside the joint's limits", told)
        self.assertNotIn("degrees", told)


class Springs(HostileFiles):
    def test_a_compliance_without_its_exponent_is_refused_where_it_stands(self):
        path = self.planned()
        yaml = self.robot(yaml=("compliance: 0.54e-6", "compliance: 0.54"))
        told = self.refusal(FLEXCOMP, "table", "--model", yaml, "--path", path, "--out",
                            self.folder / "t.fct")
        self.assertRegex(told, r"robot\.yaml:\d+: 'joints\.joint_a1\.compliance': 0\.54 rad/\(N·m\) is softer "
                               r"than any robot; expected 0\.1 rad/\(N·m\) at most")


class Masses(HostileFiles):
    def test_a_mass_that_cannot_be_read_is_never_taken_for_none(self):
        path = self.planned()
        for i, mass in enumerate(("220,0", "nan", "inf", "", "220 kg", "0x10", "1e999")):
            with self.subTest(mass):
                yaml = self.robot(f"r{i}", urdf=('mass value="220"', f'mass value="{mass}"'))
                told = self.refusal(FLEXCOMP, "table", "--model", yaml, "--path", path, "--out",
                                    self.folder / "t.fct")
                self.assertRegex(told, r"kr270\.urdf:\d+: link '[^']+': <mass>: value: expected a finite number")


if __name__ == "__main__":
    unittest.main()
