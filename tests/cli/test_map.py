"""flexcomp map as a process engineer drives it."""

import csv
import json
import unittest

from command import KR270, ROBOTS, Command


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
        rows = list(csv.DictReader((out / "map.csv").read_text().splitlines()))
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

    def test_a_square_that_fits_nowhere_has_no_place(self):
        for region in self.summary("--region", "3", "--step", "0.2")["regions"]:
            self.assertEqual({"size": 3.0, "x": None, "z": None, "worst": None}, region)

    def test_every_shipped_robot_has_a_map(self):
        for model in sorted(ROBOTS.glob("*/robot.yaml")):
            with self.subTest(robot=model.parent.name):
                summary = self.summary("--step", "0.2", model=model)
                self.assertLess(summary["min"], summary["max"])

    def test_what_makes_no_map_is_refused(self):
        for words, saying in ((("--step", "0"), "step"), (("--step", "1e-6"), "step"),
                              (("--radius", "-1"), "radius"), (("--radius", "9"), "reach"),
                              (("--points", "3"), "points"), (("--force", "1,nan,2"), "finite"),
                              (("--region", "-1"), "--region"), (("--preset", "loose"), "--preset")):
            with self.subTest(words=words):
                self.assert_refused("map", "--model", KR270, "--out", self.folder / "map", *words,
                                    saying=saying)


if __name__ == "__main__":
    unittest.main()
