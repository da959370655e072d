"""flexcomp form, and circularity's filter, as a test engineer drives them."""

import json
import math
import unittest

from command import Command


def circle(radius, deviation=lambda angle: 0.0, count=720):
    angles = [2 * math.pi * i / count for i in range(count)]
    radii = [radius + deviation(angle) for angle in angles]
    return "x,z\n" + "".join(f"{r * math.cos(a)!r},{r * math.sin(a)!r}\n" for r, a in zip(radii, angles))


class Form(Command):
    def test_a_wave_on_a_line(self):
        path = self.file("line.csv", "x,z\n" + "".join(f"{i},{(-1) ** i * 5e-5!r}\n" for i in range(10)))
        said = json.loads(self.run_well("form", "straightness", path, "--json"))
        self.assertAlmostEqual(1e-4, said["minimum_zone"], delta=1e-12)
        self.assertGreaterEqual(said["least_squares"], said["minimum_zone"])
        self.assertIn("0.100000", self.run_well("form", "straightness", path))

    def test_a_chequered_surface(self):
        rows = (f"{i},{j},{(i + j) % 2 * 2e-5!r}\n" for i in range(5) for j in range(5))
        path = self.file("surface.csv", "x,y,z\n" + "".join(rows))
        said = json.loads(self.run_well("form", "flatness", path, "--json"))
        self.assertEqual(25, said["points"])
        self.assertAlmostEqual(2e-5, said["minimum_zone"], delta=1e-12)

    def test_circles_run_both_ways(self):
        cw = self.file("cw.csv", circle(0.1, lambda a: 1e-5 * math.sin(2 * a)))
        ccw = self.file("ccw.csv", circle(0.1, lambda a: -1e-5 * math.sin(2 * a)))
        words = ("form", "circle", "--cw", cw, "--ccw", ccw, "--radius", "0.1")
        said = json.loads(self.run_well(*words, "--json"))
        self.assertAlmostEqual(2e-5, said["bidirectional_circular_deviation"], delta=1e-8)
        self.assertAlmostEqual(2e-5, said["circular_hysteresis"], delta=1e-8)
        self.assertIsNone(said["filter"])
        self.assertIn("no filter", self.run_well(*words))
        self.assertIn("50 undulations", self.run_well(*words, "--filter", "50"))

    def test_a_filter_takes_waves_away_and_is_stated(self):
        path = self.file("wavy.csv", circle(0.1, lambda a: 1e-5 * math.sin(30 * a)))
        bare = json.loads(self.run_well("circularity", path, "--json"))
        smooth = json.loads(self.run_well("circularity", path, "--filter", "30", "--json"))
        self.assertNotIn("filter", bare)
        self.assertEqual(30, smooth["filter"])
        self.assertAlmostEqual(0.5 * bare["lsc"]["circularity"], smooth["lsc"]["circularity"], delta=3e-7)
        self.assertIn("30 undulations", self.run_well("circularity", path, "--filter", "30"))

    def test_what_has_no_form_is_refused(self):
        point = self.file("point.csv", "x,z\n1,1\n1,1\n")
        good = self.file("good.csv", circle(0.1))
        for words, saying in ((("straightness", point), "point.csv: fewer than two"),
                              (("flatness", good), "column 'y' is missing"),
                              (("circle", "--cw", good, "--ccw", point, "--radius", "0.1"), "fewer"),
                              (("circle", "--cw", good, "--ccw", good, "--radius", "0"), "radius"),
                              (("circle", "--cw", good, "--ccw", good, "--radius", "1", "--filter", "-2"),
                               "cut-off")):
            with self.subTest(words=words):
                self.assert_refused("form", *words, saying=saying)


if __name__ == "__main__":
    unittest.main()
