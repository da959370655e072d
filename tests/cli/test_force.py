"""flexcomp force as a process engineer drives it."""

import csv
import json
import math
import unittest

from command import KR270, Command

MILL = ("--diameter", "0.016", "--teeth", "4", "--depth", "0.003", "--feed-per-tooth", "8e-5",
        "--shear", "700e6,210e6,110e6", "--edge", "24e3,28e3,3e3")
MODEL = ("--model", KR270)
GROUP = ("fx", "fy", "fz", "mx", "my", "mz")


class Force(Command):
    def path(self, *more):
        path = self.folder / "path.csv"
        self.run_well("plan", "circle", *MODEL, "--center", "1.6,0,1.2", "--plane", "xz",
                      "--out", path, *more)
        return path

    def wrenches(self, *more):
        out = self.folder / "milled.csv"
        self.run_well("force", *MILL, *MODEL, "--out", out, *more)
        return [[float(row[name]) for name in GROUP] for row in csv.DictReader(out.read_text().splitlines())]

    def test_the_mean_of_a_slot_is_the_closed_form(self):
        said = json.loads(self.run_well("force", *MILL, "--json"))
        na, c = 4 * 0.003, 8e-5
        expected = (-na / 4 * 210e6 * c - na / math.pi * 28e3, na / 4 * 700e6 * c + na / math.pi * 24e3,
                    na / math.pi * 110e6 * c + na / 2 * 3e3)
        for one, other in zip(expected, said["mean_force"]):
            self.assertAlmostEqual(one, other, delta=1e-4 * abs(one))
        self.assertGreater(said["peak_force"], math.hypot(*expected))

    def test_a_path_gets_its_mean_wrench_against_the_feed(self):
        said = json.loads(self.run_well("force", *MILL, "--json"))
        for row in self.wrenches("--path", self.path()):
            self.assertAlmostEqual(math.hypot(*said["mean_force"]), math.hypot(*row[:3]), delta=1e-6)
            self.assertAlmostEqual(math.hypot(*said["mean_moment"]), math.hypot(*row[3:]), delta=1e-6)

    def test_every_tooth_can_be_seen_pass(self):
        path = self.path("--points", "2000", "--feed", "0.2")  # 3.1 s
        rows = self.wrenches("--path", path, "--speed", "120")
        loads = [math.hypot(*row[:3]) for row in rows]
        self.assertGreater(max(loads), 1.05 * min(loads))
        said = json.loads(self.run_well("force", *MILL, "--json"))
        self.assertLessEqual(max(loads), said["peak_force"] * (1 + 1e-9))

    def test_the_path_can_be_compensated_with_it(self):
        out = self.folder / "milled.csv"
        self.run_well("force", *MILL, *MODEL, "--path", self.path(), "--out", out)
        self.run_well("table", *MODEL, "--path", out, "--tolerance", "1e-6",
                      "--out", self.folder / "t.fct")

    def test_what_cannot_be_milled_is_refused(self):
        path = self.path()
        out = self.folder / "out.csv"
        for words, saying in ((("--helix", "2"), "helix"), (("--mode", "up", "--width", "1"), "width"),
                              (("--path", path), "go together"),
                              ((*MODEL, "--path", path, "--out", out, "--speed", "5000"), "a tooth passes"),
                              (("--runout", "-1"), "runout"), (("--mode", "sideways"), "--mode")):
            with self.subTest(words=words):
                self.assert_refused("force", *MILL, *words, saying=saying)


if __name__ == "__main__":
    unittest.main()
