"""flexcomp select as a process engineer drives it."""

import json
import unittest

from command import ROBOTS, Command

KR100 = ROBOTS / "kr100" / "robot.yaml"
KR500 = ROBOTS / "kr500" / "robot.yaml"


class Select(Command):
    def select(self, *words):
        return json.loads(self.run_well("select", *words, "--step", "0.1", "--json"))

    def test_the_table_agrees_with_the_maps(self):
        said = self.select("--robot", f"{KR100}=100", "--robot", KR500, "--force-levels", "500,2000",
                           "--limits", "0.0005,0.002")
        for robot, model in zip(said["robots"], (KR100, KR500)):
            mapped = json.loads(self.run_well("map", "--model", model, "--step", "0.1", "--json",
                                              "--out", self.folder / "map"))
            self.assertEqual(mapped["min"], robot["min_circularity"])
            self.assertEqual(mapped["regions"][1], robot["place"])
        self.assertEqual(4, len(said["table"]))
        for cell in said["table"]:
            suitable = [robot["name"] for robot in said["robots"]
                        if robot["min_circularity"] * cell["force"] / robot["at_force"] <= cell["circularity"]
                        and (robot["largest_load"] is None or cell["force"] <= robot["largest_load"])]
            self.assertEqual(suitable, cell["robots"], cell)

    def test_a_payload_limits_the_force(self):
        words = ("--force-levels", "1000", "--limits", "0.01")
        self.assertEqual(1, len(self.select("--robot", KR100, *words)["table"][0]["robots"]))
        self.assertEqual([], self.select("--robot", f"{KR100}=100", *words)["table"][0]["robots"])

    def test_what_cannot_be_chosen_from_is_refused(self):
        for words, saying in ((("--robot", f"{KR100}=heavy"), "PAYLOAD"),
                              (("--robot", f"{KR100}=-1"), "PAYLOAD"),
                              (("--robot", self.folder / "none.yaml"), "none.yaml"),
                              (("--robot", KR100, "--limits", "0"), "--limits")):
            with self.subTest(words=words):
                self.assert_refused("select", *words, saying=saying)


if __name__ == "__main__":
    unittest.main()
