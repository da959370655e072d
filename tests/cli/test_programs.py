"""Programs in and out, as a process engineer drives it."""

import json
import pathlib
import unittest

from command import KR270, ROBOTS, Command

POCKET = """%
(A POCKET)
G21 G17 G90
S8000 M3
N30 G0 X0 Y0 Z20
G1 Z-3 F900 (PLUNGE)
G1 X25 F1800 ; to the wall
G3 X-25 Y0 I-25 J0
G3 X25 Y0 I25 J0
G1 X40 Y30
G0 Z20
M5
M30
"""
RADIAL_FREE = ("--force", "100,800,300", "--moment", "0,0,0")


class Programs(Command):
    def correct(self, program, *options):
        """Plans, corrects and hands out paths: planned and corrected."""
        path, table, corrected = (self.folder / name for name in ("path.csv", "t.fct", "corrected.csv"))
        self.run_well("plan", "program", program, "--model", KR270, "--out", path, *options)
        self.run_well("table", "--model", KR270, "--path", path, "--out", table)
        self.run_well("compensate", "--model", KR270, "--table", table, "--path", path, "--out", corrected)
        return path, corrected

    def contour(self, wanted, path):
        recording = self.folder / "recording.csv"
        self.run_well("simulate", "--model", KR270, "--path", path, "--out", recording)
        return json.loads(self.run_well("contour", "--model", KR270, "--path", wanted, "--recording", recording,
                                        "--json"))["largest"]

    def test_every_format_holds_the_same_correction(self):
        program = self.file("pocket.nc", POCKET)
        path, corrected = self.correct(program, "--frame", "1.6,0.1,0.9", *RADIAL_FREE)
        before = self.contour(path, path)
        self.assertGreater(before, 1e-4)
        self.assertLess(self.contour(path, corrected), 0.01 * before)
        for name in ("out.src", "out.mod", "out.csv", "out.nc"):
            with self.subTest(name):
                out, back = self.folder / name, self.folder / "back.csv"
                self.run_well("export", "--model", KR270, "--program", program, "--path", path,
                              "--corrected", corrected, "--out", out)
                if out.suffix != ".csv" and out.suffix != program.suffix:
                    self.assertIn("pocket.nc, corrected for the deflection of the robot by flexcomp.", out.read_text())
                frame = () if name in ("out.src", "out.mod") else ("--frame", "1.6,0.1,0.9")
                self.run_well("plan", "program", out, "--model", KR270, "--along", corrected, "--out", back, *frame)
                if out.suffix == ".src":  # by the controller's default, nothing, every point would be a stop
                    self.assertIn("\n$APO.CDIS=0.3 ;", out.read_text())
                # G-code of three axes has no orientation; and a turned tool bends a little otherwise.
                self.assertLess(self.contour(path, back), 0.03 * before)

    def test_a_placed_job_is_exported_where_it_stands(self):
        program = self.file("pocket.nc", POCKET)
        path = self.folder / "path.csv"
        placed, back, out = (self.folder / name for name in ("placed.csv", "back.csv", "out.src"))
        self.run_well("plan", "program", program, "--model", KR270, "--frame", "1.9,0,1.2", "--out", path)
        self.run_well("place", "--model", KR270, "--path", path, "--out", placed, "--evaluations", "100", "--most-turn",
                      "0.3")
        said = json.loads(self.run_well("export", "--model", KR270, "--program", program, "--path", placed,
                                        "--corrected", placed, "--out", out, "--json"))
        self.assertEqual(0, said["largest_correction"])
        self.assertIn("pocket.nc, written without a correction by flexcomp.", out.read_text())
        self.assertEqual(0, said["added"] - sum("CIRC" in line for line in out.read_text().splitlines()) + 2)
        self.run_well("plan", "program", out, "--model", KR270, "--along", placed, "--out", back)
        stiff = self.folder / "stiff.csv"
        self.run_well("simulate", "--model", KR270, "--path", back, "--compliance-scale", "1e-9", "--out", stiff)
        error = json.loads(self.run_well("contour", "--model", KR270, "--path", placed, "--recording", stiff, "--json"))
        self.assertLess(error["largest"], 1.2e-5)  # the chord errors of both

    def test_g_code_keeps_its_words_and_comments(self):
        program = self.file("pocket.nc", POCKET)
        path, corrected = self.correct(program, "--frame", "1.6,0.1,0.9", *RADIAL_FREE)
        out = self.folder / "out.nc"
        self.run_well("export", "--model", KR270, "--program", program, "--path", path, "--corrected", corrected,
                      "--out", out)
        lines = out.read_text().splitlines()
        for kept in ("%", "(A POCKET)", "G21 G17 G90", "S8000 M3", "M5", "M30"):
            self.assertIn(kept, lines)
        self.assertTrue(any(line.startswith("N30 G90 G0 X") for line in lines))
        self.assertEqual(1, sum("(PLUNGE)" in line for line in lines))
        self.assertEqual(1, sum("; to the wall" in line for line in lines))

    def test_no_format_has_a_place_that_the_g_code_does_not_tell(self):
        """Two tools, as CAM writes them: of each the first rapid is before the tool's length and Z."""
        job = "G0 X{0}. Y0.\nG43 Z40. H{1}\nG0 Z5.\nG1 Z-1. F300.\nX{2}.\nG0 Z40.\n"
        program = self.file("two.nc", "G90 G94 G17 G21\nG28 G91 Z0.\nG90\nT1 M6\nS8000 M3\n" + job.format(0, 1, 20) +
                            "M5\nG28 G91 Z0.\nG90\nT2 M6\nS9000 M3\n" + job.format(80, 2, 90) + "M30\n")
        path, corrected = self.correct(program, "--frame", "1.6,0,0.8", *RADIAL_FREE)
        texts = {}
        for ending in ("nc", "src", "mod", "csv"):
            out = self.folder / f"out.{ending}"
            self.run_well("export", "--model", KR270, "--program", program, "--path", path, "--corrected", corrected,
                          "--out", out)
            texts[ending] = out.read_text()
        lines = texts["nc"].splitlines()
        for kept in ("G28 G91 Z0.", "G0 X0. Y0.", "G0 X80. Y0."):
            self.assertIn(kept, lines)
        self.assertIn("G90 G0 X80.0000 Y0.0000 Z40.0000 G43 H2", lines)
        heights = [float(row.split(",")[2]) for row in texts["csv"].splitlines()[1:]]
        self.assertAlmostEqual(0.04, heights[0], places=9)
        for ending, first in (("src", r"PTP {X 0.0000,Y 0.0000,Z 40.0000"), ("mod", "MoveJ [[0.0000,0.0000,40.0000]")):
            lines = [line.strip() for line in texts[ending].splitlines()]
            move = next(line for line in lines if line.startswith(first[:4]))
            self.assertTrue(move.startswith(first), move)

    def test_a_name_with_parentheses_does_not_end_a_comment_of_g_code(self):
        program = self.file("pocket (2).csv", "x,y,z\n0,0,0\n0.04,0,0\n0.04,0.02,0\n")
        path, corrected = self.correct(program, "--frame", "1.6,0.1,0.9", *RADIAL_FREE)
        out = self.folder / "out.nc"
        said = self.run_well("export", "--model", KR270, "--program", program, "--path", path, "--corrected", corrected,
                             "--out", out)
        self.assertIn("pocket [2].csv, corrected for", out.read_text().splitlines()[0])
        self.assertRegex(said, "largest correction [0-9.]+ mm")

    def test_pockets_and_lines_are_planned(self):
        path = self.folder / "path.csv"
        self.run_well("plan", "pocket", "--model", KR270, "--size", "0.1,0.06,0.004", "--out", path)
        self.run_well("plan", "line", "--model", KR270, "--from", "1.5,-0.2,1", "--to", "1.5,0.2,1", "--out", path)
        rows = path.read_text().splitlines()
        self.assertEqual(81 + 1, len(rows))

    def test_another_tool_moves_the_tcp(self):
        tools = self.file("tools.yaml", "schema: flexcomp/tools/1\ntools:\n  short: {xyz: [0, 0, 0.1]}\n"
                                        "  long: {xyz: [0, 0, 0.3]}\n")
        paths = {}
        for name in ("short", "long"):
            path = paths[name] = self.folder / f"{name}.csv"
            self.run_well("plan", "line", "--model", KR270, "--tool", f"{tools}:{name}", "--from", "1.5,-0.2,1",
                          "--to", "1.5,0.2,1", "--out", path)
        error = json.loads(self.run_well("contour", "--model", KR270, "--tool", f"{tools}:short", "--path",
                                         paths["short"], "--recording", self.stiff(paths["long"], f"{tools}:long"),
                                         "--json"))
        self.assertLess(error["largest"], 1e-6)
        self.assert_refused("plan", "line", "--model", KR270, "--tool", f"{tools}:thick", "--from", "1,0,1", "--to",
                            "1,1,1", "--out", self.folder / "o.csv", saying="has no 'thick'; expected one of: short, long")

    def stiff(self, path, tool):
        out = self.folder / "stiff.csv"
        self.run_well("simulate", "--model", KR270, "--tool", tool, "--path", path, "--compliance-scale", "1e-9",
                      "--out", out)
        return out

    def test_unusable_programs_are_refused(self):
        out = self.folder / "o.csv"
        for name, text, saying in (("p.nc", "G1 X1 Y1 Z1 F60\nG5 X2\n", "p.nc:2: 'G5': unknown word"),
                                   ("p.nc", "G0 X0 Y0 Z10\nG53 G0 Z0\nG1 X10 F600\n",
                                    "p.nc:3: Z is not known: line 2 goes to a place of the machine"),
                                   ("p.nc", "M3\n", "p.nc: a program without motions"),
                                   ("p.txt", "G0 X1\n", "no program's ending"),
                                   ("p.csv", "x,y,z,w\n1,2,3,4\n", "p.csv:1: column 'w' is unknown"),
                                   ("p.csv", "x,y,z,feed\n1,2,3,0\n", "p.csv:2: column 'feed'"),
                                   ("p.csv", "x,y,z\n1,2,3\n", "p.csv: a program needs two motions or more"),
                                   ("p.src", "DEF p()\nLIN XP1\nEND\n", "p.src:2: 'XP1'")):
            with self.subTest(name + text):
                program = self.file(name, text)
                self.assert_refused("plan", "program", program, "--model", KR270, "--out", out, saying=saying)

    def test_a_work_frame_in_degrees_or_millimetres_is_refused(self):
        program, out = self.file("pocket.nc", POCKET), self.folder / "path.csv"
        for frame, saying in (("1.6,0.1,0.9,90,0,0", "--frame: expected radians, found 90"),
                              ("1600,100,900", "--frame: expected metres, found 1600")):
            self.assert_refused("plan", "program", program, "--model", KR270, "--frame", frame, "--out", out,
                                saying=saying)

    def test_a_correction_of_another_placement_is_not_exported(self):
        program = self.file("pocket.nc", POCKET)
        path, corrected = self.correct(program, "--frame", "1.6,0.1,0.9", *RADIAL_FREE)
        elsewhere, out = self.folder / "elsewhere.csv", self.folder / "o.src"
        self.run_well("plan", "program", program, "--model", KR270, "--frame", "1.7,0.1,0.9", "--out", elsewhere)
        self.assert_refused("export", "--model", KR270, "--program", program, "--path", elsewhere, "--corrected",
                            corrected, "--out", out, saying="which is no correction")
        self.assertFalse(out.exists())

    def test_a_path_of_another_program_is_not_exported(self):
        program = self.file("pocket.nc", POCKET)
        path = self.folder / "path.csv"
        self.run_well("plan", "program", program, "--model", KR270, "--frame", "1.6,0.1,0.9", "--out", path)
        other = self.file("other.nc", POCKET.replace("X40 Y30", "X40 Y31"))
        self.assert_refused("export", "--model", KR270, "--program", other, "--path", path, "--corrected", path,
                            "--out", self.folder / "o.src", saying="is not the path of this program")


if __name__ == "__main__":
    unittest.main()
