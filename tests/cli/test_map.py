"""flexcomp map as a process engineer drives it."""

import csv
import json
import os
import shutil
import signal
import subprocess
import time
import unittest

from command import FLEXCOMP, KR270, ROBOTS, Command, flexcomp

SANITIZED = os.environ.get("FLEXCOMP_SANITIZED") == "ON"


def rows_of(file):
    return list(csv.DictReader(file.read_text().splitlines()))


class Map(Command):
    def map(self, *more, model=KR270):
        out = self.folder / "map"
        printed = self.run_well("map", "--model", model, "--out", out, *more)
        return out, printed

    def summary(self, *more, model=KR270):
        return json.loads(self.map("--json", *more, model=model)[1])

    def test_four_files_are_written_that_agree(self):
        out, printed = self.map("--radius", "0.1", "--force", "440,1370,635", "--moment", "0,3,10.5",
                                "--step", "0.1", "--region", "0.2,0.4", "--json")
        self.assertEqual({"map.csv", "map.svg", "map.png", "summary.json"},
                         {path.name for path in out.iterdir()})
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual(summary, json.loads(printed))
        rows = rows_of(out / "map.csv")
        values = [float(row["circularity"]) for row in rows if row["circularity"]]
        self.assertEqual(summary["nodes_in_reach"], len(values))
        self.assertLess(len(values), len(rows))
        self.assertAlmostEqual(summary["min"], min(values), places=9)
        self.assertAlmostEqual(summary["max"], max(values), places=9)
        self.assertAlmostEqual(summary["middle"], sum(values) / len(values), places=9)
        self.assertEqual([0.2, 0.4], [region["size"] for region in summary["regions"]])
        for region in summary["regions"]:
            inside = [float(row["circularity"]) for row in rows if row["circularity"]
                      and abs(float(row["x"]) - region["x"]) <= region["size"] / 2 + 1e-9
                      and abs(float(row["z"]) - region["z"]) <= region["size"] / 2 + 1e-9]
            self.assertEqual((round(region["size"] / 0.1) + 1) ** 2, len(inside))
            self.assertAlmostEqual(region["worst"], max(inside), places=9)
        self.assertTrue((out / "map.png").read_bytes().startswith(b"\x89PNG"))
        self.assertTrue((out / "map.svg").read_text().startswith("<svg"))

    def test_an_explicit_force_overrides_the_presets(self):
        own = self.summary("--preset", "flange", "--step", "0.2")
        self.assertEqual([1104, 0, 0], own["force"])
        half = self.summary("--preset", "flange", "--step", "0.2", "--force", "552,0,0")
        self.assertEqual("tcp", half["point"])
        self.assertAlmostEqual(own["max"] / 2, half["max"], delta=0.01 * own["max"])

    def test_the_readings_of_the_study_can_be_mixed(self):
        counter = self.summary("--preset", "counter", "--step", "0.2")
        mixed = self.summary("--first-order", "--wrench-sense", "against", "--step", "0.2")
        for key in ("min", "max", "mean", "middle", "middle_is"):
            self.assertEqual(counter[key], mixed[key], key)
        free = self.summary("--no-limits", "--step", "0.2")
        self.assertGreater(free["nodes_in_reach"], self.summary("--step", "0.2")["nodes_in_reach"])

    def test_circles_of_another_plane_are_those_of_a_volume(self):
        words = "map", "--model", KR270, "--preset", "flange", "--points", "12", "--step", "0.4"
        out, volume = self.folder / "map", self.folder / "volume"
        said = json.loads(self.run_well(*words, "--plane", "xy", "--region", "0.3", "--out", out, "--json"))
        self.assertEqual("xy", said["plane"])
        self.assertLess(40, said["nodes_in_reach"])
        self.run_well(*words, "--volume", "1.2,2,0,0,0.8,1.6", "--out", volume)
        section = {(row["x"], row["z"]): row["circularity"] for row in rows_of(out / "map.csv")}
        self.assertIn(("-2", "1.2"), section)  # the arm turned round
        for row in rows_of(volume / "volume.csv"):
            self.assertAlmostEqual(float(row["circularity"]), float(section[row["x"], row["z"]]), delta=1e-9)

    def test_a_square_that_fits_nowhere_has_no_place(self):
        for region in self.summary("--region", "3", "--step", "0.2")["regions"]:
            self.assertEqual({"size": 3.0, "x": None, "z": None, "worst": None}, region)

    def test_every_shipped_robot_has_a_map(self):
        for model in sorted(ROBOTS.glob("*/robot.yaml")):
            with self.subTest(robot=model.parent.name):
                summary = self.summary("--step", "0.2", model=model)
                self.assertLess(summary["min"], summary["max"])

    def test_a_tcp_a_micrometre_off_the_plane_has_a_map(self):
        urdf = (ROBOTS / "kr270" / "kr270.urdf").read_text()
        for off, is_mapped in (("0.00000014", True), ("0.02", False)):
            self.file("kr270.urdf", urdf.replace('<origin xyz="0 0 0" rpy="0 1.57', f'<origin xyz="0 {off} 0" rpy="0 1.57'))
            model = self.file("robot.yaml", KR270.read_text())
            words = "map", "--model", model, "--preset", "flange", "--step", "0.4", "--out", self.folder / "map"
            done = flexcomp(*words)
            self.assertEqual(0 if is_mapped else 2, done.returncode, done.stderr)
            self.assertEqual(not is_mapped, "20 mm beside it; flexcomp map --volume" in done.stderr)

    def test_what_makes_no_map_is_refused(self):
        for words, saying in ((("--step", "0"), "step"), (("--step", "1e-6"), "step"),
                              (("--radius", "-1"), "radius"), (("--radius", "9"), "reach"),
                              (("--points", "3"), "points"), (("--force", "1,nan,2"), "finite"),
                              (("--region", "-1"), "--region"), (("--preset", "loose"), "--preset"),
                              (("--force", "0,0,0", "--moment", "0,0,0"), "every circle is round"),
                              (("--force", "0,0,0", "--moment", "0,0,0", "--plane", "xy"), "every circle is round"),
                              (("--plane", "xy", "--volume", "1,2,0,1,0,1"), "--plane"),
                              (("--tool-axes", "0,0,1"), "--volume")):
            with self.subTest(words=words):
                self.assert_refused("map", "--model", KR270, "--out", self.folder / "map", *words,
                                    saying=saying)


BOX = ("--volume", "1.2,2.0,-0.4,0.4,0.8,1.6", "--step", "0.4", "--points", "24", "--preset", "flange",
       "--tool-axes", "0,0,-1,1,0,0")


class Volume(Command):
    def sweep(self, name, *more, box=BOX, launcher=()):
        out = self.folder / name
        words = [*launcher, str(FLEXCOMP), "map", "--model", str(KR270), "--out", str(out), *box, *more]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(0, done.returncode, done.stderr)
        return out, done.stdout

    def test_the_size_of_the_sweep_is_stated_first(self):
        out, printed = self.sweep("volume")
        self.assertTrue(printed.startswith("3 × 3 × 3 nodes, 2 tool axes: 54 circles of 24 points"))
        self.assertEqual({"volume.csv", "summary.json"}, {path.name for path in out.iterdir()})

    def test_a_circle_of_the_volume_is_as_round_as_one_planned_and_simulated(self):
        rows = rows_of(self.sweep("volume")[0] / "volume.csv")
        row = next(row for row in rows if (row["x"], row["y"], row["z"]) == ("1.6", "0", "1.2")
                   and row["tool_z"] == "-1")
        path, recording = self.folder / "path.csv", self.folder / "recording.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--plane", "xy", "--force",
                      "1104,0,0", "--tool-axis=0,0,-1", "--points", "24", "--out", path)
        self.run_well("simulate", "--model", KR270, "--path", path, "--out", recording)
        circle = json.loads(self.run_well("circularity", recording, "--columns", "x,y", "--json"))
        # The map is linear (eq. 15), the simulation is the equilibrium itself.
        expected = circle["lsc"]["circularity"]
        self.assertAlmostEqual(expected, float(row["circularity"]), delta=0.01 * expected)

    def test_an_interrupted_sweep_goes_on_where_it_ended(self):
        step = "0.2" if SANITIZED else "0.1"  # so that there is time to interrupt it, and not too much
        finer = [word if word != "0.4" else step for word in BOX]
        whole = (self.sweep("whole", box=finer)[0] / "volume.csv").read_bytes()
        out = self.folder / "broken"
        words = [FLEXCOMP, "map", "--model", KR270, "--out", out, *finer]
        with subprocess.Popen(words, stdout=subprocess.DEVNULL) as running:
            while running.poll() is None and not list(out.glob("unfinished-*/layer-00000?")):
                time.sleep(0.001)
            running.send_signal(signal.SIGINT)
        self.assertFalse((out / "volume.csv").exists())
        self.assertTrue(list(out.glob("unfinished-*/layer-00000?")))
        self.sweep("broken", box=finer)
        self.assertEqual(whole, (out / "volume.csv").read_bytes())
        self.assertEqual([], list(out.glob("unfinished-*")))

    @unittest.skipUnless(shutil.which("mpirun"), "mpirun (Debian: openmpi-bin) is not installed")
    def test_two_processes_give_the_same_bytes(self):
        alone = (self.sweep("alone")[0] / "volume.csv").read_bytes()
        launcher = ("mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "2")
        out, printed = self.sweep("shared", launcher=launcher)
        self.assertIn("2 processes", printed)
        self.assertEqual(alone, (out / "volume.csv").read_bytes())

    def test_boxes_that_make_no_sense_are_refused(self):
        for words, saying in ((("--volume", "2,1,0,1,0,1"), "inside out"),
                              (("--volume", "0,1,0,1,0,1", "--step", "1e-5"), "1e8"),
                              (("--volume", "1,2,0,1,0,1", "--tool-axes", "0,0"), "--tool-axes"),
                              (("--volume", "1,2,0,1,0,1", "--tool-axes", "0,0,0"), "direction")):
            with self.subTest(words=words):
                done = flexcomp("map", "--model", KR270, "--out", self.folder / "map", *words)
                self.assertEqual(2, done.returncode)
                self.assertIn(saying, done.stderr)


if __name__ == "__main__":
    unittest.main()
