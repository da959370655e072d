"""Adaptive robust control from the command line: design, demonstration, and the moving plant."""

import json
import os
import subprocess
import unittest

from command import ROBOTS, SOURCE, Command

KR360 = ROBOTS / "kr360" / "robot.yaml"
DESIGN = ROBOTS / "kr360" / "arc.yaml"
SANITIZED = os.environ.get("FLEXCOMP_SANITIZED") == "ON"
SLOW = unittest.skipIf(SANITIZED, "half a minute a design; host.gain_design has the same code")


class Design(Command):
    def design(self, *more):
        out = self.folder / "arc"
        printed = self.run_well("design-arc", "--model", KR360, "--uncertainty", DESIGN, "--out", out, *more)
        return out, printed

    @SLOW
    def test_it_writes_parameters_a_header_a_summary_and_pictures(self):
        out, _ = self.design()
        self.assertEqual({"arc_gains.yaml", "arc_gains.h", "summary.json", "cost.svg", "cost.png"},
                         {path.name for path in out.iterdir()})
        self.assertTrue((out / "cost.png").read_bytes().startswith(b"\x89PNG"))

    @SLOW
    def test_every_gain_is_the_one_root_of_its_quartic_or_the_most_the_slope_allows(self):
        summary = json.loads(self.design("--json")[1])
        for joint in summary["joints"]:
            for side in ("link", "motor"):
                quartic = joint[side]["quartic"]
                root = quartic["root"]
                self.assertEqual(1, len(quartic["roots_by_companion"]))
                self.assertAlmostEqual(1, quartic["roots_by_companion"][0] / root, delta=1e-9)
                self.assertAlmostEqual(1, (root**4 + quartic["p"] * root) / quartic["r"], delta=1e-9)
                allowed = joint[side]["gain_limit"] / joint[side]["bound_limit"]**2
                self.assertAlmostEqual(1, joint[side]["gain"] / min(root, allowed), delta=1e-12)

    @SLOW
    def test_the_header_compiles_as_c(self):
        out, _ = self.design()
        program = self.file("use.c", '#include "arc_gains.h"\nint main(void) {\n'
                            "  return arc_gains.link_adaptation[5][2] > 0 && arc_gains.period < 0.01f ? 0 : 1;\n}\n")
        compiled = self.folder / "use"
        subprocess.run([os.environ["FLEXCOMP_C"], "-std=c11", "-Wall", "-Wextra", "-Werror", "-I", out, "-I",
                        SOURCE / "include", program, "-o", compiled], check=True)
        subprocess.run([compiled], check=True)

    def test_what_makes_no_design_is_refused(self):
        text = DESIGN.read_text()
        for change, saying in ((("flexcomp/arc-design/1", "flexcomp/arc-design/9"), "schema"),
                               (("link_mass:", "link_mas:"), "link_mass"),
                               (("[0.9, 1, 1.1]", "[1.1, 1, 0.9]"), "link_mass"),
                               (("degrees: [0, 1, 1, 0]", "degrees: [0, 1, 0]"), "degrees"),
                               (("[0.8, 0.95, 1.05, 1.2]", "[0, 0.95, 1.05, 1.2]"), "above zero"),
                               (("velocity: 0.3", "velocity: -1"), "velocity"),
                               (("rotor_inertia: [400, 450", "rotor_inertia: [0, 450"), "rotor_inertia")):
            with self.subTest(change=change):
                self.assertIn(change[0], text)
                design = self.file("design.yaml", text.replace(*change))
                self.assert_refused("design-arc", "--model", KR360, "--uncertainty", design, "--out",
                                    self.folder / "arc", saying=saying)

    @SLOW
    def test_a_joint_of_which_all_is_certain_is_refused(self):
        text = DESIGN.read_text()
        design = self.file("design.yaml", text[:text.index("uncertain:")]
                           + "uncertain: {start_error: {triangular: [-0.001, 0, 0.001]}}\n")
        self.assert_refused("design-arc", "--model", KR360, "--uncertainty", design, "--out",
                            self.folder / "arc", saying="nothing is uncertain of one side of a joint")

    @SLOW
    def test_gains_too_fast_for_the_period_are_refused(self):
        design = self.file("design.yaml", DESIGN.read_text() + "bandwidth: {period: 0.004}\n")
        self.assert_refused("design-arc", "--model", KR360, "--uncertainty", design, "--out",
                            self.folder / "arc", saying="refuses")


@unittest.skipIf(SANITIZED, "minutes of simulated six-axis motion")
class Demonstration(Command):
    def test_adaptive_control_and_the_compensator_beat_the_servo(self):
        out = self.folder / "demo"
        printed = self.run_well("arc-demo", "--model", KR360, "--uncertainty", DESIGN, "--out", out, "--json")
        summary = json.loads(printed)
        self.assertEqual(summary, json.loads((out / "summary.json").read_text()))

        def largest(run):
            return sum(error**2 for error in run["after_load"]["largest_error"])**0.5

        for arm in ("two_link_arm", "six_axes"):
            runs = {run["controller"]: run for run in summary[arm]}
            self.assertLess(largest(runs["adaptive robust"]), 0.2 * largest(runs["servo (PD)"]))
        circle = {run["control"]: run for run in summary["circle"]}
        for worse, better in (("servo", "servo + compensator"), ("servo + compensator", "adaptive robust")):
            self.assertLess(circle[better]["circularity"], 0.5 * circle[worse]["circularity"])
        self.assertLess(circle["adaptive robust + compensator"]["largest_deviation"],
                        circle["adaptive robust"]["largest_deviation"])


@unittest.skipIf(SANITIZED, "minutes of simulated six-axis motion")
class MovingPlant(Command):
    def mill(self, model, *more):
        path, table, run = (self.folder / name for name in ("path.csv", "t.fct", "run.csv"))
        self.run_well("plan", "circle", "--model", model, "--center", "2,0,1.2", "--plane", "xz", "--force",
                      "220,685,300", "--points", "120", "--out", path)
        self.run_well("table", "--model", model, "--path", path, "--tolerance", "1e-5", "--out", table)
        self.run_well("plant", "--model", KR360, "--path", path, "--table", table, "--out", run, *more)
        circle = json.loads(self.run_well("circularity", run, "--columns", "x,z", "--json"))
        return circle["lsc"]["circularity"]

    def test_the_compensator_helps_the_moving_robot_too(self):
        moving = ("--dynamic", DESIGN)
        # The rest is the servo's own error, which it does not know.
        self.assertLess(self.mill(KR360, *moving), 0.75 * self.mill(KR360, *moving, "--without-compensation"))

    def test_adaptive_control_needs_no_compensation_of_the_joints(self):
        text = KR360.read_text().replace("kr360.urdf", str(KR360.parent / "kr360.urdf"))
        for value in ("0.86e-6", "0.17e-6", "0.25e-6", "2.17e-6", "1.47e-6", "2.96e-6"):
            self.assertIn(value, text)
            text = text.replace(value, "0")
        stiff = self.file("stiff.yaml", text)
        self.assertLess(self.mill(stiff, "--dynamic", DESIGN, "--arc"),
                        0.2 * self.mill(KR360, "--dynamic", DESIGN, "--without-compensation"))

    def test_compensating_twice_is_refused(self):
        with self.assertRaisesRegex(AssertionError, "made for another robot"):
            self.mill(KR360, "--dynamic", DESIGN, "--arc")


if __name__ == "__main__":
    unittest.main()
