"""tools/bench tells what became worse since its figures were written."""

import pathlib
import unittest

from suite import comparison, readme, result

HERE = pathlib.Path(__file__).parent


def topic(instructions=849, ratio=15.8, at_most=0.07, time=25.8e-9):
    return result.Topic(
        "A control tick",
        [result.Figure("full guarded tick", instructions, "instructions"), result.Figure("look-up", time, "s")],
        [result.Ratio("Pinocchio's time / a look-up's", ratio, goal=15),
         result.Ratio("flexcomp's time, s", at_most, goal=1, at_most=True),
         result.Ratio("a look-up's time / the floor's", ratio)],
        [], ("", ""))


def page(written):
    machine = {"processor": "a processor", "cores": 2, "compiler": "c++", "flexcomp": "0.1.0"}
    return "\n".join(readme.lines_of_figures(machine, {"tick": written}))


class Comparison(unittest.TestCase):
    def worse(self, measured):
        return comparison.worse(comparison.figures_of(page(topic()))["tick"], measured)

    def test_nothing_is_worse_than_itself(self):
        self.assertEqual([], self.worse(topic()))

    def test_more_instructions_are_told(self):
        self.assertEqual(["full guarded tick: 1,200 instructions, was 849 instructions"], self.worse(topic(1200)))

    def test_a_figure_of_thousands_is_read_whole(self):
        before = comparison.figures_of(page(topic(12345)))["tick"]
        self.assertEqual([], comparison.worse(before, topic(12345)))
        self.assertEqual(1, len(comparison.worse(before, topic(13000))))

    def test_a_ratio_is_worse_where_its_goal_says_so(self):
        self.assertEqual(["Pinocchio's time / a look-up's: 10.0, was 15.8"], self.worse(topic(ratio=10)))
        self.assertEqual([], self.worse(topic(ratio=30)))
        self.assertEqual(["flexcomp's time, s: 0.20, was 0.07"], self.worse(topic(at_most=0.2)))

    def test_times_and_what_was_not_measured_before_are_not_compared(self):
        self.assertEqual([], self.worse(topic(time=1)))
        self.assertEqual([], comparison.worse({}, topic(99999)))

    def test_the_figures_that_stand_in_the_page_are_found(self):
        found = comparison.figures_of((HERE / "README.md").read_text())
        self.assertGreater(comparison.number(found["instructions"]["full guarded tick"]), 100)
        self.assertGreater(comparison.number(found["tick"]["Pinocchio's time / a look-up's"]), 1)


if __name__ == "__main__":
    unittest.main()
