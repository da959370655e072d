"""flexcomp check as a person and a program use it."""

import csv
import json
import math
import re
import unittest

from command import KR270, Command, flexcomp

KEYS = ["severity", "about", "name", "what", "fix"]


class Check(Command):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "path.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--plane", "xz",
                      "--points", "400", "--out", self.path)

    def check(self, *arguments, exit_code):
        """The checks of --json, whose exit code is as expected."""
        done = flexcomp("check", *arguments, "--json")
        self.assertEqual(exit_code, done.returncode, done.stderr + done.stdout)
        self.assertEqual("", done.stderr)
        answer = json.loads(done.stdout)
        self.assertEqual(["checks"], list(answer))
        for each in answer["checks"]:
            self.assertEqual(KEYS, list(each))
            self.assertIn(each["severity"], ("error", "warning", "note"))
        return answer["checks"]

    def wrong(self, *arguments):
        return [each["name"] for each in self.check(*arguments, exit_code=1)
                if each["severity"] != "note"]

    def changed(self, source, name, **columns):
        """A copy of a recording whose columns are changed by functions of their value."""
        with source.open() as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            for column, change in columns.items():
                row[column] = repr(change(float(row[column])))
        target = self.folder / name
        with target.open("w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)
        return target

    def recorded(self):
        recording = self.folder / "recording.csv"
        self.run_well("simulate", "--model", KR270, "--path", self.path, "--out", recording)
        return recording

    def table(self):
        table = self.folder / "t.fct"
        self.run_well("table", "--model", KR270, "--path", self.path, "--tolerance", "1e-5", "--out", table)
        return table

    def robot(self, before, after):
        """A copy of the KR 270's description with one change."""
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {KR270.parent / 'kr270.urdf'}")
        self.assertIn(before, text)
        return self.file("robot.yaml", text.replace(before, after))

    def test_a_payload_without_weight_is_told(self):
        payload = "payload: {mass: 120, com: [0, 0, 0.15]}\n"
        model = self.robot("gravity: [0, 0, 0]\n", "gravity: [0, 0, 0]\n" + payload)
        self.assertEqual(["gravity.missing"], self.wrong("--model", model))
        self.check("--model", self.robot("gravity: [0, 0, 0]\n", "gravity: [0, 0, -9.81]\n" + payload), exit_code=0)

    def test_an_arm_whose_links_have_no_mass_weighs_nothing(self):
        urdf = (KR270.parent / "kr270.urdf").read_text()
        massless = self.file("massless.urdf", re.sub(r"<inertial>.*?</inertial>", "", urdf, flags=re.DOTALL))
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {massless}")
        self.check("--model", self.file("robot.yaml", text), exit_code=0)
        heavy = self.file("heavy.yaml", text.replace("gravity: [0, 0, 0]", "gravity: [0, 0, -9.81]"))
        self.assertEqual(["masses.missing"], self.wrong("--model", heavy))
        spindle = self.file("spindle.yaml", heavy.read_text() + "tool: {xyz: [0, 0, 0.2], mass: 12}\n")
        self.assertEqual(["masses.missing"], self.wrong("--model", spindle))

    def test_an_effect_beyond_what_machines_have_is_told(self):
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {KR270.parent / 'kr270.urdf'}")
        for gap, names in ((2.1e-3, []), (2.1, ["effect.size"])):
            effect = f"effects:\n  - {{effect: backlash, joint: 2, form: load, gap: {gap}, hold: 25}}\n"
            said = self.check("--model", self.file("robot.yaml", text + effect), exit_code=len(names))
            self.assertEqual(names, [each["name"] for each in said])

    def test_a_tool_in_millimetres_or_degrees_is_told(self):
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {KR270.parent / 'kr270.urdf'}")
        self.assertEqual(["tool.size"], self.wrong("--model", self.file("mm.yaml", text + "tool: {xyz: [0, 0, 250]}\n")))
        degrees = self.file("degrees.yaml", text + "tool: {xyz: [0, 0, 0.25], rpy: [0, 90, 0]}\n")
        self.assert_refused("check", "--model", degrees, saying="'tool.rpy': expected radians, found 90")

    def test_a_tool_in_grams_and_millimetres_is_told(self):
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {KR270.parent / 'kr270.urdf'}")
        tool = "tool: {xyz: [0, 0, 0.25], mass: 12000, com: [0, 0, 100]}\n"
        self.assertEqual(["tool.size", "payload.size"], self.wrong("--model", self.file("g.yaml", text + tool)))
        tool = "tool: {xyz: [0, 0, 0.25], mass: 12, com: [0, 0, 0.1]}\n"
        self.assertEqual([], self.check("--model", self.file("kg.yaml", text + tool), exit_code=0))

    def test_a_recording_without_joint_angles_is_told(self):
        recording = self.file("r.csv", "t,x,y,z\n0,1,2,3\n0.1,1,2,3\n")
        self.assertEqual(["column.missing"], self.wrong("--model", KR270, "--recording", recording))

    def test_a_force_in_another_unit_is_told_though_the_robot_could_not_bear_it(self):
        kilo = self.changed(self.recorded(), "kilo.csv", **{name: lambda value: 1e5 * value for name in ("fx", "fy", "fz")})
        self.assertEqual(["units.wrench"], self.wrong("--model", KR270, "--recording", kilo))
        done = flexcomp("diagnose", "--model", KR270, "--recording", kilo, "--out", self.folder / "d")
        self.assertEqual(2, done.returncode)
        self.assertRegex(done.stderr, r"^flexcomp: .*kilo\.csv: row \d+, under .* N and .* N·m: .* units first, .*units\.wrench.*\n$")

    def test_limits_of_the_deflection_below_what_the_path_needs_are_told(self):
        table, config = self.table(), self.folder / "node.toml"
        self.run_well("configure", "--model", KR270, "--table", table, "--out", config)
        words = ("--model", KR270, "--path", self.path, "--table", table, "--config", config)
        self.check(*words, exit_code=0)
        with self.recorded().open() as file:
            rows = list(csv.DictReader(file))
        stiff = self.file("stiff.yaml", re.sub(r"compliance: [^,}\s]+", "compliance: 1e-12", KR270.read_text()).replace(
            "urdf: kr270.urdf", f"urdf: {KR270.parent / 'kr270.urdf'}"))
        self.run_well("simulate", "--model", stiff, "--path", self.path, "--out", self.folder / "s.csv")
        with (self.folder / "s.csv").open() as file:
            straight = list(csv.DictReader(file))
        most = max(math.dist(*([float(row[axis]) for axis in "xyz"] for row in pair)) for pair in zip(rows, straight))
        text = config.read_text()
        for option, factor, severity in (("deflection-error", 0.9, "error"), ("deflection-limit", 0.9, "warning"),
                                         ("deflection-error", 1.1, None)):
            config.write_text(text + f"{option} = {factor * most:.6f}\n")
            found = [each["severity"] for each in self.check(*words, exit_code=1 if severity else 0)
                     if each["name"] == "config.deflection"]
            self.assertEqual([severity] if severity else [], found, option)

    def test_effects_that_a_table_lacks_are_told_where_it_is_made_and_checked(self):
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {KR270.parent / 'kr270.urdf'}")
        model = self.file("learnt.yaml", text + "effects:\n  - {effect: joint_offset, joint: 3, offset: 2e-3}\n"
                          "  - {effect: torque_offset, joint: 2, torque: 30}\n")
        table, config = self.folder / "t.fct", self.folder / "node.toml"
        for words in (("table", "--path", self.path, "--tolerance", "1e-5", "--out", table),
                      ("configure", "--table", table, "--out", config)):
            done = flexcomp(words[0], "--model", model, *words[1:])
            self.assertEqual(0, done.returncode, done.stderr)
            self.assertRegex(done.stderr, r"^flexcomp: .*learnt\.yaml: effects: .*lacks joint_offset: .*\n$")
        self.assertEqual(["table.effects"], self.wrong("--model", model, "--table", table))

    def test_a_tool_frame_whose_x_points_out_of_the_flange_is_noted(self):
        urdf = (KR270.parent / "kr270.urdf").read_text()
        before = re.search(r'<child link="tool0"/>.*?</joint>', urdf, re.DOTALL).group()
        bare = self.file("bare.urdf", urdf.replace(before, re.sub(r'rpy="[^"]*"', 'rpy="0 0 0"', before)))
        text = KR270.read_text().replace("urdf: kr270.urdf", f"urdf: {bare}")
        said = self.check("--model", self.file("robot.yaml", text), exit_code=0)
        self.assertEqual(["tool.axis"], [each["name"] for each in said])
        straight = text + "tool: {xyz: [0, 0, 0.25]}\n"
        said = self.check("--model", self.file("straight.yaml", straight), exit_code=0)
        self.assertEqual(["tool.axis"], [each["name"] for each in said])
        turned = text + "tool: {xyz: [0.25, 0, 0], rpy: [0, 1.5707963, 0]}\n"
        self.assertEqual([], self.check("--model", self.file("turned.yaml", turned), exit_code=0))

    def test_what_goes_together_is_in_order(self):
        recording, table = self.recorded(), self.table()
        config = self.folder / "node.toml"
        self.run_well("configure", "--model", KR270, "--table", table, "--out", config)
        said = self.check("--model", KR270, "--recording", recording, "--path", self.path, "--table",
                          table, "--config", config, exit_code=0)
        self.assertEqual([], [each for each in said if each["severity"] != "note"])

    def test_the_table_that_a_configuration_names_is_read(self):
        table, config = self.table(), self.folder / "node.toml"
        self.run_well("configure", "--model", KR270, "--table", table, "--out", config)
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        moved = elsewhere / "node.toml"
        moved.write_text(config.read_text().replace(str(table), "t.fct"))
        self.assertEqual(["config.table"], self.wrong("--model", KR270, "--config", moved))
        (elsewhere / "t.fct").write_bytes(table.read_bytes())  # a relative one stands beside it
        self.check("--model", KR270, "--config", moved, exit_code=0)
        (elsewhere / "t.fct").write_bytes(table.read_bytes()[:500])
        self.assertEqual(["config.table"], self.wrong("--model", KR270, "--config", moved))

    def test_a_slower_controller_bears_less_gain(self):
        table, config = self.folder / "t.fct", self.folder / "node.toml"
        self.run_well("table", "--model", KR270, "--path", self.path, "--depth-of-cut", "0.0014", "--out", table)
        self.run_well("configure", "--model", KR270, "--table", table, "--period", "0.02", "--out", config)
        gain = float(re.search(r"^gain = ([0-9.]+)", config.read_text(), re.MULTILINE).group(1))
        self.run_well("table", "--model", KR270, "--path", self.path, "--depth-of-cut", "0.0014", "--loop-period",
                      "0.02", "--out", self.folder / "slow.fct")
        slow = json.loads(self.run_well("table", "verify", self.folder / "slow.fct", "--model", KR270, "--json"))
        self.assertAlmostEqual(slow["largest_gain"], gain, delta=1e-3)
        self.check("--model", KR270, "--config", config, exit_code=0)
        config.write_text(re.sub(r"(?m)^gain = .*", "gain = 1", config.read_text()))
        self.assertEqual(["config.gain"], self.wrong("--model", KR270, "--config", config))

    def test_a_person_reads_what_is_wrong_and_what_to_do(self):
        in_mm = self.changed(self.recorded(), "mm.csv", **{axis: lambda v: 1000 * v for axis in "xyz"})
        done = flexcomp("check", "--model", KR270, "--recording", in_mm)
        self.assertEqual(1, done.returncode)
        self.assertIn("error (units.position)", done.stdout)
        self.assertIn("millimetres", done.stdout)
        self.assertIn("divide them by 1000", done.stdout)

    def test_several_recordings_are_told_apart(self):
        good = self.recorded()
        down = self.changed(good, "down.csv", z=lambda v: -v)
        said = self.check("--model", KR270, "--recording", good, "--recording", down, exit_code=1)
        wrong = [each for each in said if each["severity"] != "note"]
        self.assertEqual(["frame.base"], [each["name"] for each in wrong])
        self.assertIn("down.csv", wrong[0]["what"])

    def test_times_that_repeat_are_a_finding_not_a_refusal(self):
        lines = self.path.read_text().splitlines()
        twice = self.file("twice.csv", "\n".join([*lines[:5], lines[4], *lines[5:]]) + "\n")
        self.assertEqual(["units.time"], self.wrong("--model", KR270, "--path", twice))

    def test_a_path_beyond_limits_or_table_or_in_degrees(self):
        table = self.table()
        beyond = self.changed(self.path, "beyond.csv", q_cmd_2=lambda v: v + 2)
        self.assertIn("limits", self.wrong("--model", KR270, "--path", beyond))
        degrees = self.changed(self.path, "degrees.csv",
                               **{f"q_cmd_{k}": lambda v: 57.29577951 * v for k in range(1, 7)})
        self.assertEqual(["units.angle"], self.wrong("--model", KR270, "--path", degrees))
        other = self.folder / "other.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "1.8,0,1.4", "--plane", "xz",
                      "--points", "60", "--out", other)
        self.assertEqual(["table.coverage"],
                         self.wrong("--model", KR270, "--path", other, "--table", table))
        hard = self.changed(self.path, "hard.csv", fx=lambda v: 10 * v)
        self.assertIn("table.coverage", self.wrong("--model", KR270, "--path", hard, "--table", table,
                                                   "--no-process"))

    def test_a_cut_that_digs_in(self):
        self.assertEqual(["process.unstable"],
                         self.wrong("--model", KR270, "--path", self.path, "--depth-of-cut", "1e-4"))

    def test_times_that_one_late_message_upsets(self):
        config = self.folder / "node.toml"
        self.run_well("configure", "--model", KR270, "--table", self.table(), "--out", config)
        usual = config.read_text()
        for name, value in (("setpoint-age-limit", 0.003), ("wrench-age-limit", 0.001), ("hold-time", 0.002),
                            ("filter-cutoff", 200)):  # of a node with a period of 4 ms
            config.write_text(f"{usual}\n{name} = {value}\n")
            self.assertIn("config.times", self.wrong("--model", KR270, "--config", config), name)
        config.write_text(usual)
        self.check("--model", KR270, "--config", config, exit_code=0)

    def test_speeds_of_all_joints_that_are_wrong_are_one_warning(self):
        config = self.folder / "node.toml"
        self.run_well("configure", "--model", KR270, "--out", config)
        text = config.read_text()
        for speeds in ("[0.1, 0.1, 0.1, 0.1, 0.1, 0.1]", "[20, 20, 20, 20, 20, 20]"):
            config.write_text(re.sub(r"^joint-speed = .*$", f"joint-speed = {speeds}", text, flags=re.MULTILINE))
            self.assertEqual(["config.speed"], self.wrong("--model", KR270, "--config", config))

    def test_a_table_and_a_configuration_of_another_robot(self):
        table = self.table()
        config = self.folder / "node.toml"
        self.run_well("configure", "--model", KR270, "--table", table, "--out", config)
        other = KR270.parent.parent / "kr500" / "robot.yaml"
        self.assertEqual(["table.other", "config.model"],
                         self.wrong("--model", other, "--table", table, "--config", config)[:2])

    def test_a_spring_out_of_the_usual_range(self):
        (self.folder / "kr270.urdf").write_text((KR270.parent / "kr270.urdf").read_text())
        soft = self.file("robot.yaml", KR270.read_text().replace("0.54e-6", "0.54e-3"))
        self.assertEqual(["compliance.size"], self.wrong("--model", soft))

    def test_what_cannot_be_read_is_refused(self):
        self.assert_refused("check", saying="nothing to check")
        self.assert_refused("check", "--model", KR270, "--recording", self.file("a.csv", "t,x\n0,b\n"),
                            saying="a.csv:2")
        self.assert_refused("check", "--model", KR270, "--table", self.file("t.fct", b"nothing"),
                            saying="t.fct")


if __name__ == "__main__":
    unittest.main()
