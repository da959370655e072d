"""flexcomp place as a process engineer drives it."""

import json
import unittest

from command import KR270, Command


class Place(Command):
    def test_a_job_far_out_is_drawn_nearer_and_milled_better(self):
        path = self.folder / "path.csv"
        placed = self.folder / "placed.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "2.1,0,1.4", "--plane", "xz",
                      "--points", "60", "--out", path)
        said = json.loads(self.run_well("place", "--model", KR270, "--path", path, "--out", placed,
                                        "--evaluations", "300", "--points", "12", "--json"))
        self.assertLess(said["after"]["largest"], 0.8 * said["before"]["largest"])
        self.assertTrue(said["on_bound"])  # nearer still would be better
        printed = self.run_well("place", "--model", KR270, "--path", path, "--out", self.folder / "turned.csv",
                                "--evaluations", "100", "--points", "12", "--most-shift", "0,0,0")
        self.assertNotIn("--most-shift", printed)
        circularity = []
        for job in (path, placed):
            recording = self.folder / "recording.csv"
            self.run_well("simulate", "--model", KR270, "--path", job, "--out", recording)
            circle = json.loads(self.run_well("circularity", recording, "--columns", "x,z", "--json"))
            circularity.append(circle["lsc"]["circularity"])
        self.assertLess(circularity[1], 0.8 * circularity[0])

    def test_what_cannot_be_placed_is_refused(self):
        path = self.file("path.csv", "t,x\n0,1\n")
        self.assert_refused("place", "--model", KR270, "--path", path, "--out", self.folder / "o.csv",
                            saying="path.csv")


if __name__ == "__main__":
    unittest.main()
