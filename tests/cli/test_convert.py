"""flexcomp convert with tables that others wrote."""

import csv
import json
import math
import unittest

from command import Command

RULES = ("--map", "t=Zeit:ms", "--map", "q_cmd_*=A*:deg", "--map", "tau_*=Last A*:%*-750")
TABLE = ("Gerät 7\n"
         "Zeit;Zustand;A1;A2;Last A1;Last A2\n"
         "1700000000000;fährt;-90,0;45;50;1\n"
         "1700000000012;fährt;-89,5;;50,5;1\n")


class Convert(Command):
    def converted(self, text=TABLE, rules=(*RULES, "--header-line", "2"), name="axes.txt"):
        out = self.folder / "out.csv"
        self.said = self.run_well("convert", self.file(name, text), *rules, "--out", out)
        return list(csv.DictReader(out.read_text().splitlines()))

    def test_a_table_of_a_controller_becomes_a_recording(self):
        first, second = self.converted()
        self.assertEqual(["t", "q_cmd_1", "q_cmd_2", "tau_1", "tau_2"], list(first))
        self.assertEqual((0, 0.012), (float(first["t"]), float(second["t"])))
        self.assertAlmostEqual(-math.pi / 2, float(first["q_cmd_1"]), 12)
        self.assertAlmostEqual(math.radians(-89.5), float(second["q_cmd_1"]), 12)
        self.assertEqual("", second["q_cmd_2"])
        self.assertAlmostEqual(-378.75, float(second["tau_1"]), 12)
        self.assertIn("out.csv: 2 rows\nleft out, because no rule names it: Zustand\n", self.said)

    def test_columns_that_no_line_names_are_named_by_the_user(self):
        rows = self.converted("838.5,0.1,-1.5,7\n838.6,0.2,-1.4,8\n",
                              ("--names", "time,a1,a2", "--map", "t=time", "--map", "q_meas_*=a*"))
        self.assertEqual([["0", "0.1", "-1.5"], ["0.2", "-1.4"]],
                         [list(rows[0].values()), list(rows[1].values())[1:]])
        self.assertAlmostEqual(0.1, float(rows[1]["t"]), 9)
        self.assertIn("left out, because no rule names it: 4\n", self.said)

    def test_a_table_without_names_is_told_how_to_give_them(self):
        table = self.file("axes.txt", "838.5,0.1\n838.6,0.2\n")
        out = self.folder / "out.csv"
        self.assert_refused("convert", table, "--map", "t=time", "--out", out,
                            saying="has no column 'time'; it has 838.5, 0.1; where no line names the columns, "
                                   "give --names")
        self.assert_refused("convert", table, "--names", "time,a1,a2", "--map", "t=time", "--out", out,
                            saying="axes.txt:1: expected 3 cells as there are names, found 2")

    def test_what_it_did_is_told_as_json(self):
        self.converted(rules=(*RULES, "--header-line", "2", "--json"))
        self.assertEqual({"rows": 2, "left_out": ["Zustand"]}, json.loads(self.said))

    def test_a_table_becomes_a_log_of_a_bus(self):
        names = [f"q{joint}" for joint in range(1, 7)]
        text = ",".join(["time", *names]) + "\n0,1,2,3,4,5,6\n0.004,1,2,3,4,5,6\n"
        log, back = self.folder / "a.log", self.folder / "back.csv"
        self.run_well("convert", self.file("a.csv", text), "--map", "t=time", "--map", "q_cmd_*=q*:deg", "--out", log)
        self.run_well("convert", log, "--out", back)
        row = next(csv.DictReader(back.read_text().splitlines()))
        self.assertAlmostEqual(math.radians(6), float(row["q_cmd_6"]), 6)

    def test_without_rules_it_says_what_the_table_has(self):
        out = self.folder / "out.csv"
        file = self.file("axes.csv", "time;axis 1\n0;1\n")
        self.assert_refused("convert", file, "--out", out,
                            saying="axes.csv: which column is which? Say it with --map, as in --map t=time:ms "
                                   "--map 'q_meas_*=joint*:deg'; it has time, axis 1")

    def test_refusals_name_the_rule_or_the_line_and_leave_nothing(self):
        out = self.folder / "out.csv"
        file = self.file("axes.csv", "time;axis 1\n0;1\n1;one\n")
        self.assert_refused("convert", file, "--map", "t=time", "--map", "tau_1=axis 1", "--out", out,
                            saying="axes.csv:3: column 'axis 1': 'one' is not a finite number")
        self.assert_refused("convert", file, "--map", "t=clock", "--out", out,
                            saying="--map t=clock: " + str(file) + " has no column 'clock'; it has time, axis 1")
        self.assert_refused("convert", file, file, "--map", "t=time", "--out", out,
                            saying="expected one recording, or logs of buses")
        self.assert_refused("convert", self.file("axes.txt", "time\n0\n"), "--out", out, saying="or --map")


if __name__ == "__main__":
    unittest.main()
