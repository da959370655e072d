"""The flexcomp command as its users drive it."""

import csv
import json
import math
import os
import pathlib
import re
import shutil
import socket
import stat
import struct
import subprocess
import tempfile
import unittest
import zlib

from command import FLEXCOMP, KR270, ROBOTS, SOURCE, Command, flexcomp

HEADER_BYTES = 268


class PathCommand(Command):
    def plan(self, model=KR270, *more):
        path = self.folder / "path.csv"
        self.make_once(path, "plan", "circle", "--model", model, "--center", "1.6,0,1.2", "--plane", "xz",
                       "--points", "120", *more)
        return path

    def table(self, path, model=KR270, *more):
        table = self.folder / "table.fct"
        self.make_once(table, "table", "--model", model, "--tolerance", "1e-6", *more, path=path)
        return table

    def circularity(self, recording):
        return json.loads(self.run_well("circularity", recording, "--columns", "x,z", "--json"))


class MainJob(PathCommand):
    def test_the_corrected_circle_keeps_less_than_two_percent_of_the_error(self):
        for robot in ("kr100", "kr270", "kr360", "kr500"):
            with self.subTest(robot=robot):
                model = ROBOTS / robot / "robot.yaml"
                path = self.plan(model)
                table = self.table(path, model)
                corrected, before, after = (self.folder / name for name in ("c.csv", "b.csv", "a.csv"))
                self.run_well("compensate", "--model", model, "--table", table, "--path", path,
                              "--out", corrected)
                self.run_well("simulate", "--model", model, "--path", path, "--out", before)
                self.run_well("simulate", "--model", model, "--path", corrected, "--out", after)
                error = self.circularity(before)["lsc"]["circularity"]
                left = self.circularity(after)["lsc"]["circularity"]
                self.assertGreater(error, 1e-4)
                self.assertLess(left, 0.02 * error)

    def test_wrong_springs_leave_their_share_of_the_error(self):
        path = self.plan()
        table = self.table(path)
        corrected, before, after = (self.folder / name for name in ("c.csv", "b.csv", "a.csv"))
        self.run_well("compensate", "--model", KR270, "--table", table, "--path", path,
                      "--out", corrected)
        self.run_well("simulate", "--model", KR270, "--path", path, "--out", before)
        self.run_well("simulate", "--model", KR270, "--path", corrected, "--compliance-scale", "1.2",
                      "--out", after)
        error = self.circularity(before)["lsc"]["circularity"]
        left = self.circularity(after)["lsc"]["circularity"]
        self.assertAlmostEqual(0.2, left / error, delta=0.01)

    @unittest.skipIf(os.environ.get("FLEXCOMP_SANITIZED") == "ON", "the tests beside it run the same code")
    def test_weight_and_every_spring_are_corrected_too(self):
        robot = self.folder / "robot"
        shutil.copytree(ROBOTS / "kr270", robot)
        text = (robot / "robot.yaml").read_text().replace("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]")
        (robot / "robot.yaml").write_text(
            text + "base_compliance: [1e-8, 1e-8, 1e-8, 1e-8, 1e-8, 1e-8]\n"
            "tool_compliance: [2e-8, 2e-8, 1e-8, 1e-7, 1e-7, 1e-7]\n"
            "payload: {mass: 120, com: [0, 0, 0.15]}\n")
        model = robot / "robot.yaml"
        path = self.plan(model)
        table = self.table(path, model)
        summary = json.loads(self.run_well(
            "compensate", "--model", model, "--table", table, "--path", path, "--json",
            "--out", self.folder / "c.csv"))
        self.assertGreater(summary["before"]["position"], 3e-3)
        self.assertLess(summary["after"]["position"], 0.01 * summary["before"]["position"])
        self.assertLess(summary["after"]["orientation"], 0.01 * summary["before"]["orientation"])

    def learnt_model(self, *effects):
        robot = self.folder / "learnt"
        shutil.copytree(ROBOTS / "kr270", robot)
        with open(robot / "robot.yaml", "a", encoding="utf-8") as file:
            file.write("effects:\n" + "".join(f"  - {{{effect}}}\n" for effect in effects))
        return robot / "robot.yaml"

    def compensated(self, model, path):
        corrected = self.folder / f"corrected-{model.parent.name}.csv"
        # Effects are not in a table: it is that of the model without them.
        summary = self.run_well("compensate", "--model", model, "--table", self.table(path),
                                "--path", path, "--json", "--out", corrected)
        return corrected, json.loads(summary)

    def positions(self, path, scale="1"):
        out = self.folder / "positions.csv"
        self.run_well("simulate", "--model", KR270, "--path", path, "--compliance-scale", scale,
                      "--out", out)
        with open(out, encoding="utf-8") as file:
            return [[float(row[axis]) for axis in "xyz"] for row in csv.DictReader(file)]

    def test_a_joint_zero_that_a_diagnosis_learnt_is_corrected(self):
        path = self.plan()
        corrected, summary = self.compensated(
            self.learnt_model("effect: joint_offset, joint: 3, offset: 2e-3"), path)
        with open(corrected, encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for row in rows:  # the real robot stands elsewhere than it is told
            row["q_cmd_3"] = float(row["q_cmd_3"]) + 2e-3
        real = self.folder / "real.csv"
        with open(real, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        stiff = self.positions(path, "1e-9")
        left = max(math.dist(a, b) for a, b in zip(self.positions(real), stiff))
        self.assertLess(left, 2e-6)
        self.assertGreater(summary["learned"]["before"], 1e-3)
        self.assertLess(summary["learned"]["after"], 2e-6)

    def test_what_only_the_measurement_showed_moves_no_command(self):
        path = self.plan()
        plain, _ = self.compensated(KR270, path)
        learnt, _ = self.compensated(
            self.learnt_model("effect: time_offset, form: tcp_position, delay: 0.05"), path)
        with open(plain, encoding="utf-8") as first, open(learnt, encoding="utf-8") as second:
            for a, b in zip(csv.DictReader(first), csv.DictReader(second), strict=True):
                for joint in range(1, 7):
                    self.assertAlmostEqual(float(a[f"q_cmd_{joint}"]), float(b[f"q_cmd_{joint}"]),
                                           delta=2e-6)

    def test_both_directions_and_every_plane_can_be_planned(self):
        for plane, tool_axis in (("xy", "0,0,-1"), ("xz", "0,1,0"), ("yz", "1,0,0")):
            for more in ((), ("--clockwise",)):
                with self.subTest(plane=plane, more=more):
                    path = self.folder / "path.csv"
                    self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0,1.0",
                                  "--plane", plane, "--tool-axis", tool_axis, "--points", "60",
                                  "--out", path, *more)
                    recording = self.folder / "r.csv"
                    self.run_well("simulate", "--model", KR270, "--path", path,
                                  "--compliance-scale", "1e-9", "--out", recording)
                    measured = json.loads(self.run_well(
                        "circularity", recording, "--columns", ",".join(plane), "--json"))
                    self.assertAlmostEqual(0.1, measured["mcc"]["r_max"], delta=1e-8)
                    self.assertLess(measured["mzc"]["circularity"], 1e-8)

    def test_the_report_is_one_page_with_pictures(self):
        path = self.plan()
        recording = self.folder / "r.csv"
        self.run_well("simulate", "--model", KR270, "--path", path, "--out", recording)
        page = self.folder / "page.html"
        self.run_well("report", "--model", KR270, "--recording", f"a <name>={recording}",
                      "--columns", "x,z", "--table", self.table(path), "--out", page)
        html = page.read_text()
        self.assertEqual(2, html.count("<svg"))
        self.assertNotIn("gnuplot", html.lower().replace("gnuplot_", ""), "a browser shows it over the picture")
        self.assertIn("a &lt;name&gt;", html)
        self.assertIn("certificate", html)
        self.assertNotIn("src=", html)


class Tables(PathCommand):
    def test_the_certificate_of_a_fresh_table_holds(self):
        path = self.plan()
        table = self.table(path)
        result = json.loads(self.run_well("table", "verify", table, "--model", KR270, "--path", path,
                                          "--samples", "30000", "--json"))
        self.assertTrue(result["holds"])
        self.assertLessEqual(result["largest_position_error"], result["certified_position_error"])
        self.assertLessEqual(result["certified_position_error"], 1e-6 * 1.000001)

    def test_a_bound_that_does_not_hold_is_exit_code_1(self):
        path = self.plan()
        table = self.table(path)
        blob = bytearray(table.read_bytes())
        struct.pack_into("<f", blob, HEADER_BYTES - 12, 1e-9)  # the certified position error
        struct.pack_into("<I", blob, 12, 0)
        struct.pack_into("<I", blob, 12, zlib.crc32(bytes(blob)))
        forged = self.file("forged.fct", bytes(blob))
        done = flexcomp("table", "verify", forged, "--model", KR270, "--samples", "1000")
        self.assertEqual(1, done.returncode, done.stderr)
        self.assertIn("DOES NOT HOLD", done.stdout)

    def test_damaged_and_foreign_tables_are_refused(self):
        path = self.plan()
        table = self.table(path)
        blob = bytearray(table.read_bytes())
        blob[700] ^= 4
        damaged = self.file("damaged.fct", bytes(blob))
        for command in (("table", "verify", damaged, "--model", KR270),
                        ("compensate", "--table", damaged, "--model", KR270, "--path", path,
                         "--out", self.folder / "c.csv")):
            self.assert_refused(*command, saying="damaged")
        self.assert_refused("table", "verify", self.file("short.fct", table.read_bytes()[:500]),
                            "--model", KR270, saying="shorter than it says")
        self.assert_refused("table", "verify", path, "--model", KR270, saying="not a flexcomp table")
        self.assert_refused("table", "verify", table, "--model", ROBOTS / "kr500" / "robot.yaml",
                            saying="another robot")

    def test_a_path_off_the_table_is_refused_with_its_row(self):
        path = self.plan()
        table = self.table(path)
        lines = path.read_text().splitlines()
        cells = lines[40].split(",")
        cells[3] = str(float(cells[3]) + 0.05)
        lines[40] = ",".join(cells)
        wrong = self.file("wrong.csv", "\n".join(lines) + "\n")
        self.assert_refused("compensate", "--model", KR270, "--table", table, "--path", wrong,
                            "--out", self.folder / "c.csv", saying="wrong.csv:41: outside the table")

    def test_a_wrench_beyond_the_certificate_is_refused(self):
        path = self.plan()
        table = self.table(path, KR270, "--force", "1000")
        self.assert_refused("compensate", "--model", KR270, "--table", table, "--path", path,
                            "--out", self.folder / "c.csv", saying="wrench beyond")


class BadInput(PathCommand):
    """A missing file, a directory, an empty file, a binary file, and worse."""

    def commands_reading(self, bad):
        path = self.file("ok.csv", "t,q_cmd_1,q_cmd_2,q_cmd_3,q_cmd_4,q_cmd_5,q_cmd_6,fx,fy,fz,mx,my,mz\n"
                         "0,0,-1,1,0,1,0,100,0,0,0,0,0\n1,0,-1.1,1,0,1,0,100,0,0,0,0,0\n")
        out = self.folder / "out"
        return [
            ("simulate", "--model", bad, "--path", path, "--out", out),
            ("simulate", "--model", KR270, "--path", bad, "--out", out),
            ("table", "--model", KR270, "--path", bad, "--out", out),
            ("table", "verify", bad, "--model", KR270),
            ("compensate", "--model", KR270, "--table", bad, "--path", path, "--out", out),
            ("circularity", bad),
            ("report", "--model", KR270, "--recording", f"a={bad}", "--out", out),
            ("plan", "circle", "--model", bad, "--center", "1.6,0,1.2", "--out", out),
        ]

    def test_files_that_cannot_be_read(self):
        bad_files = {
            "no such file": self.folder / "missing",
            "is a directory": self.folder,
            "empty": self.file("empty", ""),
        }
        for saying, bad in bad_files.items():
            for command in self.commands_reading(bad):
                with self.subTest(saying=saying, command=command[:2]):
                    self.assert_refused(*command, saying=saying)

    def test_binary_files(self):
        binary = self.file("binary", bytes(range(256)) * 20)
        for command in self.commands_reading(binary):
            with self.subTest(command=command[:2]):
                self.assert_refused(*command, saying=str(binary))

    def test_another_file_in_the_place_of_a_table_is_said_to_be_none(self):
        text = self.file("notes.txt", "a short text")
        for command in (("table", "verify", text, "--model", KR270),
                        ("node", "send-table", "--bus", "can:nowhere", text)):
            with self.subTest(command=command[:2]):
                self.assert_refused(*command, saying=f"{text}: not a flexcomp table")

    def test_cells_and_columns(self):
        cases = {
            "t,x,z\n0,1,2\n1,abc,2\n": ":3: column 'x': 'abc'",
            "t,x,z\n0,1,2\n1,2\n": ":3: expected 3 cells",
            "t,x,z\n0,1,2\n1,nan,2\n": ":3: column 'x': 'nan'",
            "x\n1\n": "columns x, y, z",
            "x,z\n1,1\n2,2\n3,3\n": "on a line",
            "x,z\n1,1\n2,2\n": "three distinct points",
        }
        for content, saying in cases.items():
            with self.subTest(content=content):
                self.assert_refused("circularity", self.file("bad.csv", content), saying=saying)

    def test_a_robot_with_five_joints(self):
        robot = self.folder / "robot"
        shutil.copytree(ROBOTS / "kr270", robot)
        urdf = (robot / "kr270.urdf").read_text()
        (robot / "kr270.urdf").write_text(urdf.replace(
            '<joint name="joint_a4" type="revolute">', '<joint name="joint_a4" type="fixed">'))
        keys = (robot / "robot.yaml").read_text().splitlines(keepends=True)
        (robot / "robot.yaml").write_text("".join(key for key in keys if "joint_a4" not in key))
        self.assert_refused("plan", "circle", "--model", robot / "robot.yaml", "--center", "1.6,0,1.2",
                            "--out", self.folder / "p.csv", saying="six revolute joints")

    @unittest.skipUnless(stat.S_ISCHR(os.stat("/dev/full").st_mode), "/dev/full is not a device here")
    def test_a_full_disk(self):
        path = self.plan()
        table = self.table(path)
        for command in (
                ("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2"),
                ("table", "--model", KR270, "--path", path),
                ("compensate", "--model", KR270, "--table", table, "--path", path),
                ("simulate", "--model", KR270, "--path", path)):
            with self.subTest(command=command[:2]):
                self.assert_refused(*command, "--out", "/dev/full", saying="No space left")
        with open("/dev/full", "w") as full:
            done = subprocess.run([str(FLEXCOMP), "circularity", str(self.file(
                "c.csv", "x,z\n1,0\n0,1\n-1,0\n"))], stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual(2, done.returncode)
        self.assertIn("standard output", done.stderr)

    def test_an_output_folder_that_is_not_there(self):
        self.assert_refused("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2",
                            "--out", self.folder / "no" / "path.csv", saying="No such file")

    def test_circles_out_of_reach(self):
        self.assert_refused("plan", "circle", "--model", KR270, "--center", "9,0,1.2",
                            "--out", self.folder / "p.csv", saying="cannot be reached")

    def test_arguments_that_make_no_sense(self):
        path = self.plan()
        cases = [
            ((), "subcommand"),
            (("dance",), "dance"),
            (("circularity",), "path"),
            (("table", "--model", KR270), "--path"),
            (("table", "--model", KR270, "--path", path, "--out", "x", "--tolerance", "-1"), "--tolerance"),
            (("plan", "circle", "--model", KR270, "--center", "1,2", "--out", "x"), "--center"),
            (("plan", "circle", "--model", KR270, "--center", "1,2,3", "--plane", "xx", "--out", "x"), "xx"),
            (("simulate", "--model", KR270, "--path", path, "--out", "x", "--compliance-scale", "0"),
             "--compliance-scale"),
            (("simulate", "--model", KR270, "--out", "x"), "--recording"),
            (("simulate", "--model", KR270, "--path", path, "--recording", path, "--out", "x"), "either"),
            (("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--force", "nan,0,0", "--out", "x"),
             "--force: expected a finite number, not nan"),
            (("plan", "line", "--model", KR270, "--from", "1,0,1", "--to", "1,1,inf", "--out", "x"),
             "--to: expected a finite number, not inf"),
            (("configure", "--model", KR270, "--period", "nan", "--out", "x"), "--period: expected a number above zero, not nan"),
            (("table", "--model", KR270, "--path", path, "--out", "x", "--force", "-5"), "--force: expected a number above zero, not -5"),
            (("table", "--model", KR270, "--path", path, "--out", "x", "--orientation-tolerance", "nan"),
             "--orientation-tolerance: expected a number above zero, not nan"),
            (("table", "--model", KR270, "--path", path, "--out", "x", "--loop-delay", "nan"),
             "--loop-delay: expected a number of zero or above, not nan"),
            (("check", "--model", KR270, "--depth-of-cut", "10mm"), "--depth-of-cut: expected a number above zero, not 10mm"),
            (("plant", "--model", KR270, "--path", path, "--table", path, "--gain", "nan"), "--gain: expected a finite number, not nan"),
            (("report", "--model", KR270, "--recording", "nameless", "--out", "x"), "NAME=FILE"),
        ]
        for arguments, saying in cases:
            with self.subTest(arguments=arguments):
                self.assert_refused(*arguments, saying=saying)


class Manners(PathCommand):
    def test_help_and_version_go_to_standard_output(self):
        for arguments in (("--help",), ("--version",), ("table", "--help"), ("plan", "circle", "--help")):
            self.assertIn("flexcomp", self.run_well(*arguments))

    def test_help_before_a_command_is_help_after_it(self):
        for words in ((), ("table",), ("table", "verify"), ("plan", "circle")):
            self.assertEqual(self.run_well(*words, "--help"), self.run_well("help", *words))
        self.assert_refused("help", "fly", saying="'flexcomp' has no command 'fly' (see flexcomp --help)")
        self.assert_refused("help", "table", "fly", saying="'flexcomp table' has no command 'fly'")

    def test_help_lists_effects_as_a_robot_takes_them(self):
        robot = pathlib.Path(KR270).read_text()
        urdf = pathlib.Path(KR270).parent / "kr270.urdf"
        path = self.folder / "path.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--points", "20", "--out", path)
        rows = path.read_text().splitlines()
        path.write_text("\n".join([rows[0] + ",temp_c", *(row + ",20" for row in rows[1:])]) + "\n")
        robot = re.sub(r"gravity: .*", "gravity: [0, 0, -9.81]", robot)
        shown = self.run_well("help", "effects").split("\n\n")
        effects = [block for block in shown if re.match(r"[a-z_]+: ", block)]
        self.assertGreater(len(effects), 35)
        alone = self.run_well("help", "torque_ripple")
        self.assertIn("sine (N·m), cosine (N·m), order", alone)
        self.assertNotIn("backlash", alone)
        for block in effects:
            said, *forms = block.splitlines()
            name = said.split(":")[0]
            if name == "link_offset":
                continue  # its keys are of the axes across the link, which goes elsewhere here
            for form in forms:
                keys = {"effect": name}
                for part in form.strip().split("; "):
                    if part == "joint":  # joint 1 turns about z, as the page's does; some take none before the second
                        keys["joint"] = 2 if name in ("dress_pack", "transmission") else 1
                    elif part.startswith("form: "):
                        keys["form"] = part[6:]
                    else:
                        keys.update({each.split(" ")[0]: 1e-15 for each in part.split(", ")})
                with self.subTest(keys):
                    text = re.sub(r"urdf: .*", f"urdf: {urdf}", robot)
                    model = self.file("robot.yaml", text + "effects:\n  - " + json.dumps(keys) + "\n")
                    self.run_well("simulate", "--model", model, "--path", path, "--out", self.folder / "s.csv")

    def test_help_shows_values_as_words_and_marks_what_is_required(self):
        shown = self.run_well("help", "table")
        self.assertRegex(shown, r"--material TEXT:\{outside,inside\}=outside\s")
        for option in ("--model", "--path", "--out"):
            self.assertRegex(shown, rf"(?m)^  {option} TEXT REQUIRED ")
        self.assertRegex(shown, r"--force FLOAT:POSITIVE\s+N, .* if not\s+given")
        self.assertRegex(self.run_well("help", "plant"), r"--gain FLOAT in \[0 - 1\]=1 ")
        for command in re.findall(r"^  ([a-z-]+) {2,}", self.run_well("--help").split("Subcommands:")[1], re.MULTILINE):
            shown = self.run_well("help", command)
            self.assertIn(f"Usage: flexcomp {command} ", shown)
            for riddle in ("ENUM", "->", "=[] ", "FLOAT:FLOAT"):
                self.assertNotIn(riddle, shown, command)

    def test_what_is_required_of_a_command_is_not_of_its_subcommands(self):
        for command in ("table", "identify"):
            self.assert_refused(command, saying="--model is required (see --help)")
        table = self.table(self.plan())
        self.run_well("table", "verify", table, "--model", KR270)

    def test_every_command_that_writes_a_file_says_so(self):
        path, recording, page = (self.folder / name for name in ("path.csv", "recording.csv", "page.html"))
        self.assertEqual(f"{path}: 73 rows\n", self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2",
                                                            "--plane", "xz", "--points", "72", "--out", path))
        self.assertEqual(f"{recording}: 73 rows\n",
                         self.run_well("simulate", "--model", KR270, "--path", path, "--out", recording))
        self.assertEqual(f"{page}: 73 rows\n", self.run_well("simulate", "--model", KR270, "--recording", recording,
                                                            "--out", page))
        self.assertEqual(f"{page}: 1 circle\n",
                         self.run_well("report", "--model", KR270, "--columns", "x,z", "--recording", f"a={recording}",
                                       "--out", page))
        self.assertRegex(self.run_well("force", "--diameter", "0.016", "--teeth", "4", "--depth", "0.003",
                                       "--feed-per-tooth", "8e-5", "--shear", "700e6,210e6,110e6", "--model", KR270,
                                       "--path", path, "--out", recording), rf"{recording}: the path with its wrench\n$")

    def test_joints_are_told_by_their_numbers_and_names(self):
        names = ",".join(f"q_meas_{joint}" for joint in range(1, 7))
        rows = [f"{i / 100},{0.1 + 0.3 * math.sin(i / 90)},{-1.2 + 0.3 * math.sin(i / 60)},1.4,"
                f"{0.3 * math.sin(i / 40)},{0.3 * math.sin(i / 30)},{0.2 * math.sin(i / 30)}" for i in range(500)]
        recording = self.file("recording.csv", "\n".join([f"t,{names}", *rows, ""]))
        said = self.run_well("check", "--model", KR270, "--recording", recording)
        self.assertIn("joint 3 (joint_a3) never moves", said)
        self.assertIn("joints 5 (joint_a5) and 6 (joint_a6) only move together", said)
        for source in (KR270, KR270.parent / "kr270.urdf"):
            self.file(source.name, source.read_text().replace("joint_a", "joint_"))
        said = self.run_well("check", "--model", self.folder / KR270.name, "--recording", recording)
        self.assertIn("joint 3 never moves", said)

    def test_the_version_names_the_build(self):
        self.assertRegex(self.run_well("--version"), r"^flexcomp \d+\.\d+\.\d+ \(.*\)\n$")

    def test_an_existing_file_survives_a_failed_run(self):
        kept = self.file("kept.csv", "precious\n")
        self.assert_refused("plan", "circle", "--model", KR270, "--center", "9,0,1.2", "--out", kept,
                            saying="cannot be reached")
        self.assertEqual("precious\n", kept.read_text())


class StableGain(Command):
    """Shallow cuts, in which the force answers strongly where the tool is."""

    def setUp(self):
        super().setUp()
        self.path, self.table = self.folder / "path.csv", self.folder / "t.fct"
        self.make_once(self.path, "plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--plane", "xz",
                       "--points", "72")

    def build(self, *words):
        return json.loads(self.make_once(self.table, "table", "--model", KR270, "--json", *words, path=self.path))

    def test_a_table_always_says_the_gain_and_the_process_it_assumes(self):
        usual = self.build()
        self.assertEqual(1, usual["largest_gain"])
        self.assertEqual({"depth_of_cut": 0.002, "material": "outside", "loop_period": 0.004,
                          "loop_filter_cutoff": 20, "loop_delay": 0.004}, usual["process"])
        self.assertLess(self.build("--depth-of-cut", "0.001")["largest_gain"], 0.95)
        none = self.build("--no-process")
        self.assertEqual(0, none["largest_gain"])
        self.assertIsNone(none["process"])

    def test_configure_writes_the_safe_gain(self):
        largest = self.build("--depth-of-cut", "0.001")["largest_gain"]
        config = self.folder / "node.toml"
        said = self.run_well("configure", "--model", KR270, "--table", self.table, "--out", config)
        gain = float(next(line for line in config.read_text().splitlines() if line.startswith("gain =")).split()[2])
        self.assertLessEqual(gain, largest)
        self.assertGreater(gain, 0.99 * largest)
        self.assertIn(f"gain {gain}", said)

    def test_a_path_without_sides_takes_the_worst_side(self):
        rows = self.path.read_text().splitlines()
        self.path.write_text("\n".join(rows[:3]) + "\n")  # a line: no area
        self.assertLess(0, self.build("--depth-of-cut", "0.0008")["largest_gain"])

    def test_a_plant_refuses_an_unstable_loop_in_one_line_that_names_the_gain(self):
        self.build("--no-process")
        words = ("plant", "--model", KR270, "--path", self.path, "--table", self.table, "--depth-of-cut", "0.0012",
                 "--filter-cutoff", "0")
        done = flexcomp(*words, "--out", self.folder / "run.csv")
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertRegex(done.stderr, r"^flexcomp: .*the largest stable gain is 0\.\d+.*--gain.*\n$")
        self.assertFalse((self.folder / "run.csv").exists())
        steady = json.loads(self.run_well(*words, "--gain", "0.3", "--json"))
        self.assertGreater(steady["least_engagement"], 0.9)
        self.assertLess(steady["most_engagement"], 2)
        self.assertFalse(steady["lost"])

    def test_a_plant_to_which_nobody_answers_gives_up_in_lock_step_and_says_so(self):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as silent:
            silent.bind(("127.0.0.1", 0))
            address = f"udp://127.0.0.1:{silent.getsockname()[1]}"
            done = flexcomp("plant", "--model", KR270, "--path", self.path, "--rsi", address, "--lockstep")
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertEqual(f"flexcomp: {address}: nobody answers\n", done.stderr)

    def test_a_plant_says_which_fault_keeps_the_correction_from_becoming_active(self):
        self.build("--no-process")
        stiffer = self.folder / "bends.yaml"  # its own weight bends it by more than the 6 mm of deflection-error
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {KR270.parent / 'kr270.urdf'}")
        stiffer.write_text(re.sub(r"gravity: .*", "gravity: [0, 0, -9.81]", text) + "payload: {mass: 2000}\n")
        self.run_well("table", "--model", stiffer, "--path", self.path, "--no-process", "--out", self.table)
        done = flexcomp("plant", "--model", stiffer, "--path", self.path, "--table", self.table, "--allow-unstable")
        self.assertEqual(1, done.returncode, done.stdout + done.stderr)
        self.assertIn("did not become active: predicted deflection too large;", done.stdout)

    def test_a_plant_warns_of_a_gain_that_is_stable_but_not_safe(self):
        self.build("--no-process")
        done = flexcomp("plant", "--model", KR270, "--path", self.path, "--table", self.table,
                        "--depth-of-cut", "0.0012", "--filter-cutoff", "0", "--gain", "0.5")
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertRegex(done.stderr, r"the gain 0\.5 is stable but above the largest safe one, 0\.3\d+\n$")

    def test_a_cut_that_all_but_digs_in_has_no_safe_gain(self):
        process = ("--depth-of-cut", "0.0008")
        said = self.run_well("table", "--model", KR270, "--path", self.path, "--out", self.table, *process)
        self.assertIn("no stable correction gain is safe", said)
        config = self.folder / "node.toml"
        for words in (("configure", "--model", KR270, "--table", self.table, "--out", config),
                      ("plant", "--model", KR270, "--path", self.path, "--table", self.table, *process)):
            done = flexcomp(*words)
            self.assertEqual(1, done.returncode, done.stdout)
            self.assertRegex(done.stderr, r"^flexcomp: .*\n$")
        self.assertFalse(config.exists())

    def test_compensating_beforehand_closes_no_loop(self):
        corrected = []
        for process in (("--no-process",), ("--depth-of-cut", "0.001")):
            self.build(*process)
            out = self.folder / "corrected.csv"
            said = json.loads(self.run_well("compensate", "--model", KR270, "--table", self.table, "--path", self.path,
                                            "--out", out, "--json"))
            corrected.append([[float(cell) for cell in row.split(",")] for row in out.read_text().splitlines()[1:]])
        for one, other in zip(*corrected):
            for a, b in zip(one, other):
                self.assertAlmostEqual(a, b, delta=1e-9)


if __name__ == "__main__":
    unittest.main()
