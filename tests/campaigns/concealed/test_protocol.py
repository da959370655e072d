"""The blind protocol: nobody gets at the truth unseen, and the score is that of the answers."""

import contextlib
import hashlib
import io
import json
import pathlib
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import zipapp
from unittest import mock

HERE = pathlib.Path(__file__).resolve().parent
FAKES = HERE / "protocol" / "fakes"
sys.path[:0] = [str(FAKES), str(HERE), str(HERE.parent), str(HERE.parent / "diagnosis")]

import campaign  # noqa: E402
from protocol import (cases, goals, judging, loop_section, loops, report, sandbox, seal,  # noqa: E402
                      svg, watch)
from protocol import __main__ as protocol  # noqa: E402

SEED, CASES = 5, 5
TOOL_MAIN = """\
import json
import tool
tool.main({manner!r}, json.loads({oracle!r}))
"""


def scratch_folder(test):
    scratch = tempfile.TemporaryDirectory()
    test.addCleanup(scratch.cleanup)
    return pathlib.Path(scratch.name)


def touch(path):
    """Another process reads a file."""
    subprocess.run(["cat", str(path)], check=True, capture_output=True)


class Sealing(unittest.TestCase):
    def setUp(self):
        self.folder = scratch_folder(self)
        self.truth = {"000": {"effect": "coulomb_friction", "torque": 12.5}}
        self.sealed = seal.SealedTruth(self.truth, self.folder)

    def test_what_is_opened_is_what_was_sealed_and_has_the_printed_hash(self):
        self.assertEqual(self.truth, self.sealed.open())
        opened = (self.folder / "truth.json").read_bytes()
        self.assertEqual(self.sealed.sha256, hashlib.sha256(opened).hexdigest())
        checked = subprocess.run(["sha256sum", "-c", "seal.sha256"], cwd=self.folder, check=False,
                                 capture_output=True)
        self.assertEqual(0, checked.returncode)

    def test_closed_it_says_nothing(self):
        for path in self.folder.iterdir():
            self.assertNotIn(b"coulomb", path.read_bytes())

    def test_the_same_truth_has_another_hash_each_time(self):
        other = scratch_folder(self)
        self.assertNotEqual(self.sealed.sha256, seal.SealedTruth(self.truth, other).sha256)

    def test_anyone_can_open_it_with_the_published_key(self):
        self.sealed.open()
        key = bytes.fromhex((self.folder / "seal.key").read_text())
        text = seal.mask((self.folder / "truth.sealed").read_bytes(), key)
        self.assertEqual((self.folder / "truth.json").read_bytes(), text)

    def test_an_altered_truth_is_detected(self):
        path = self.folder / "truth.sealed"
        data = path.read_bytes()
        for altered in (data[:-1] + bytes([data[-1] ^ 1]), data + b"x", data[:-9], b""):
            path.write_bytes(altered)
            with self.assertRaisesRegex(seal.Altered, "the sealed truth was altered"):
                self.sealed.open()
        path.unlink()
        with self.assertRaises(seal.Altered):
            self.sealed.open()
        self.assertFalse((self.folder / "truth.json").exists())

    def test_an_altered_hash_is_detected(self):
        (self.folder / "seal.sha256").write_text("0" * 64 + "  truth.json\n")
        with self.assertRaises(seal.Altered):
            self.sealed.open()

    def test_another_truth_under_its_own_hash_is_detected(self):
        seal.SealedTruth({"000": {"effect": "backlash"}}, self.folder)
        with self.assertRaises(seal.Altered):
            self.sealed.open()


class Watching(unittest.TestCase):
    def setUp(self):
        self.file = scratch_folder(self) / "truth.sealed"
        self.file.write_text("x")
        self.watch = watch.Watch(self.file)
        self.addCleanup(self.watch.close)

    def test_left_alone_nothing_is_seen(self):
        list(self.file.parent.iterdir())
        self.file.stat()
        self.assertEqual([], self.watch.seen())

    def test_reading_is_seen_once(self):
        touch(self.file)
        self.assertEqual(["read", "opened"], self.watch.seen())
        self.assertEqual([], self.watch.seen())

    def test_reading_by_another_name_is_seen(self):
        other = self.file.with_name("other")
        other.hardlink_to(self.file)
        self.watch.seen()
        touch(other)
        self.assertIn("read", self.watch.seen())

    def test_writing_and_moving_are_seen(self):
        with self.file.open("a") as file:
            file.write("y")
        self.assertIn("written", self.watch.seen())
        self.file.rename(self.file.with_name("away"))
        self.assertIn("moved", self.watch.seen())


class Sandboxing(unittest.TestCase):
    def setUp(self):
        self.work, self.hidden = scratch_folder(self), scratch_folder(self)
        (self.hidden / "truth").write_text("secret")
        self.box = sandbox.Sandbox([], [self.hidden])

    def test_time_is_limited_with_all_that_was_started(self):
        begin = time.monotonic()
        done = self.box.run(["sh", "-c", "sleep 30 & sleep 30"], self.work, 0.5)
        self.assertIsNone(done.code)
        self.assertLess(time.monotonic() - begin, 10)

    def test_the_environment_is_bare(self):
        with mock.patch.dict("os.environ", {"SECRET": "truth"}):
            self.assertNotIn("SECRET", self.box.run(["env"], self.work, 10).output)

    def test_what_is_made_in_the_working_folder_stays(self):
        self.box.run(["touch", "made"], self.work, 10)
        self.assertTrue((self.work / "made").exists())

    def test_nothing_starts_after_a_stop(self):
        self.box.stop()
        with self.assertRaises(sandbox.Stopped):
            self.box.run(["true"], self.work, 10)

    def test_only_what_is_given_can_be_seen(self):
        if not self.box.isolated:
            self.skipTest(f"no namespaces here: {self.box.why_not}")
        for words in (["cat", str(self.hidden / "truth")], ["ls", str(HERE)], ["touch", "/usr/x"],
                      ["mount", "-t", "tmpfs", "x", "/tmp"], ["ls", f"/proc/1/root{HERE}"]):
            self.assertNotEqual(0, self.box.run(words, self.work, 10).code, words)
        processes = self.box.run(["sh", "-c", "echo /proc/[0-9]*"], self.work, 10).output.split()
        self.assertLess(len(processes), 4)

    def test_without_namespaces_this_is_said(self):
        with mock.patch.object(sandbox, "NAMESPACES", ("false",)):
            box = sandbox.Sandbox([], [self.hidden])
        self.assertFalse(box.isolated)
        self.assertEqual("in\n", box.run(["echo", "in"], self.work, 10).output)


class Contests(unittest.TestCase):
    def setUp(self):
        self.folder = scratch_folder(self)

    def ended(self, **codes):
        for name, code in codes.items():
            (self.folder / name).mkdir()
            said = {"code": code, "seconds": 1, "last_words": "" if code == 0 else "No module named sklearn"}
            (self.folder / name / "contest.json").write_text(json.dumps(said))
        return list(codes)

    def test_rivals_that_ran_nowhere_void_the_campaign(self):
        with self.assertRaisesRegex(protocol.Void, "No module named sklearn"):
            protocol.check_contests(self.folder, self.ended(first=1, second=None))

    def test_a_case_without_rivals_is_told(self):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            protocol.check_contests(self.folder, self.ended(first=0, second=1))
        self.assertEqual("Case second has no rivals: No module named sklearn\n", said.getvalue())


class Campaign(unittest.TestCase):
    """The whole command on a made-up campaign, with programs that stand in for flexcomp."""

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.scratch = pathlib.Path(scratch.name)
        written = cases.write(SEED, CASES, cls.scratch / "drawn", 1, lambda done, total: None)
        cls.oracle = {}
        for entry in written.values():
            effects = [[effect["effect"], effect["joint"], *effect["parameters"].values()]
                       for effect in entry["truth"]["effects"]]
            cls.oracle[entry["files"]["train.csv"]] = effects

    def tool(self, manner):
        """One executable file, so that it is whole in the sandbox."""
        source = self.scratch / f"{manner}_sources"
        if not source.exists():
            shutil.copytree(FAKES, source, ignore=shutil.ignore_patterns("__pycache__"))
            (source / "__main__.py").write_text(
                TOOL_MAIN.format(manner=manner, oracle=json.dumps(self.oracle)))
            zipapp.create_archive(source, self.scratch / manner, sys.executable)
        return self.scratch / manner

    def prove(self, manner, *more, out=None, count=CASES):
        """(exit code, standard output and error, folder)."""
        folder = out or self.scratch / f"campaign_{manner}"
        said = io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            code = protocol.main(["--seed", str(SEED), "--cases", str(count), "--jobs", "2",
                                  "--no-rivals", "--no-loop", "--tool", str(self.tool(manner)),
                                  "--out", str(folder), *more])
        return code, said.getvalue(), folder

    def figures(self, folder):
        return json.loads((folder / "scores.json").read_text())["figures"]

    def test_a_perfect_tool_reaches_every_goal(self):
        code, said, folder = self.prove("perfect")
        self.assertEqual(0, code, said)
        found = self.figures(folder)
        self.assertEqual([1.0, 1.0, 0.0, 0.0], [found[name]["rate"] for name in (
            goals.EFFECT, goals.JOINT, goals.ALARMS, goals.CLAIMS)])
        self.assertLess(found[goals.HELD_OUT], 1.2)
        self.assertEqual(1.0, found["parameters within their 95 % interval"]["rate"])
        self.assertNotIn("MISSED", said)
        self.assertEqual("scored\n", (folder / "STATE").read_text())
        self.assert_report_is_whole(folder, said)

    def assert_report_is_whole(self, folder, said):
        page = (folder / "report.html").read_text()
        printed = said.split("SHA-256: ")[1].split()[0]
        self.assertEqual(printed, hashlib.sha256((folder / "truth.json").read_bytes()).hexdigest())
        for part in (printed, "coulomb_friction", "moonlight", "tools/concealed --seed 5 --cases 5",
                     "sha256sum -c", "error / noise", "N·m", "right joint", "worst", "<svg"):
            self.assertIn(part, page)
        for outside in ("src=", "href=", "http"):
            self.assertNotIn(outside, page)
        self.assertNotIn(str(self.scratch), page)

    def test_a_wrong_tool_reaches_none(self):
        code, said, folder = self.prove("wrong")
        self.assertEqual(1, code)
        found = self.figures(folder)
        self.assertEqual([0.0, 1.0, 1.0], [found[name]["rate"] for name in (
            goals.JOINT, goals.ALARMS, goals.CLAIMS)])
        self.assertGreater(found[goals.HELD_OUT], 1.2)
        self.assertIn(f"MISSED  {goals.JOINT}", said)

    def test_a_tool_that_crashes_counts_against(self):
        code, said, folder = self.prove("crash")
        self.assertEqual(1, code)
        found = self.figures(folder)
        self.assertEqual([0.0, 0.0, 1.0, 1.0, 1.0], [found[name]["rate"] for name in (
            goals.EFFECT, goals.JOINT, goals.ALARMS, goals.CLAIMS, "diagnoses without an answer")])
        self.assertGreater(found[goals.HELD_OUT], 1.2)
        self.assertIn("failed: exit 3", said)

    def test_a_tool_that_overruns_counts_against(self):
        code, said, folder = self.prove("slow", "--limit", "0.7", count=2)
        self.assertEqual(1, code)
        found = self.figures(folder)
        self.assertEqual([0.0, 1.0], [found[name]["rate"] for name in (
            goals.EFFECT, "diagnoses without an answer")])
        self.assertIn("failed: no answer within", said)

    def test_a_tool_that_searches_finds_nothing(self):
        code, said, folder = self.prove("search", count=2)
        if "No sandbox" in said:
            self.skipTest("no namespaces here")
        self.assertEqual(0, code, said)
        looked = sorted((folder / "answers").glob("*/found.json"))
        self.assertEqual(2, len(looked))
        for path in looked:
            self.assertEqual([], json.loads(path.read_text()))

    def test_a_tool_that_opens_the_sealed_truth_voids_the_campaign(self):
        folder = self.scratch / "campaign_open"
        with mock.patch.object(sandbox, "NAMESPACES", ("false",)):  # as where the kernel refuses
            code, said, _ = self.prove("open", out=folder, count=2)
        self.assertEqual(1, code)
        self.assertIn("No sandbox", said)
        self.assertIn("void: the sealed truth was read, opened while diagnoses ran", said)
        self.assertIn("void", (folder / "STATE").read_text())
        for name in ("report.html", "scores.json", "truth.json"):
            self.assertFalse((folder / name).exists(), name)

    def test_a_truth_altered_while_nobody_watches_is_detected(self):
        folder = self.scratch / "campaign_altered"

        def alter(options, *rest):
            (options.out / "truth.sealed").write_bytes(b"another truth")
        with mock.patch.object(protocol, "_run_all", alter):
            code, said, _ = self.prove("perfect", out=folder, count=2)
        self.assertEqual(1, code)
        self.assertIn("the sealed truth was altered; nothing is scored", said)
        self.assertFalse((folder / "scores.json").exists())

    def test_recordings_altered_after_sealing_are_detected(self):
        folder = self.scratch / "campaign_recordings"

        def alter(options, *rest):
            (options.out / "cases" / "000" / "untrained.csv").write_text("t\n")
        with mock.patch.object(protocol, "_run_all", alter):
            code, said, _ = self.prove("perfect", out=folder, count=2)
        self.assertEqual(1, code)
        self.assertIn("the files of case 000 were altered", said)

    def test_an_interrupt_leaves_the_seal_closed(self):
        folder = self.scratch / "campaign_interrupted"
        with mock.patch.object(protocol, "_check_untouched", side_effect=KeyboardInterrupt):
            code, said, _ = self.prove("perfect", out=folder, count=2)
        self.assertEqual(130, code)
        self.assertEqual("interrupted; nothing is scored\n", (folder / "STATE").read_text())
        self.assertFalse((folder / "truth.json").exists())
        self.assertEqual(0, len([thread for thread in threading.enumerate()
                                 if thread.name.startswith("ThreadPool")]))

    def test_bad_arguments_are_refused_in_one_line(self):
        other = scratch_folder(self)
        (other / "thesis.tex").write_text("years of work")
        for words in (["--cases", "3"], ["--seed", "-1"], ["--seed", "1", "--tool", "/nowhere"],
                      ["--seed", "1", "--tool", "/bin/true", "--cases", "0"],
                      ["--seed", "1", "--tool", "/bin/true", "--limit", "nan"],
                      ["--seed", "1", "--tool", "/bin/true", "--out", str(other)]):
            said = io.StringIO()
            with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(said):
                protocol.main(words)
            self.assertEqual(2, ended.exception.code)
            self.assertIn("error:", said.getvalue().splitlines()[-1])
        self.assertTrue((other / "thesis.tex").exists())


class Drawing(unittest.TestCase):
    def write(self, seed):
        folder = scratch_folder(self)
        return cases.write(seed, 4, folder, 1, lambda done, total: None), folder

    def test_a_seed_gives_the_same_files(self):
        self.assertEqual(self.write(3)[0], self.write(3)[0])
        self.assertNotEqual(self.write(3)[0], self.write(4)[0])

    def test_names_and_order_say_nothing(self):
        written, folder = self.write(3)
        self.assertEqual(["000", "001", "002", "003"],
                         sorted(path.name for path in folder.iterdir()))
        order = [entry["truth"]["seed"] for entry in written.values()]
        self.assertNotEqual(sorted(order), order)

    def test_a_truth_left_behind_in_a_case_is_refused(self):
        def careless(case, folder):
            truth = campaign.case.write_case(case, folder)
            (folder / "model" / "truth.json").write_text(json.dumps(truth))
            return truth
        with mock.patch.object(campaign, "write_case", careless):
            with self.assertRaisesRegex(cases.Unfit, "truth.json does not belong"):
                self.write(3)

    def test_a_case_that_cannot_be_drawn_is_left_out(self):
        def picky(case, folder):
            if case.family == "clean":
                raise campaign.case.Unsuitable
            return campaign.case.write_case(case, folder)
        with mock.patch.object(campaign, "write_case", picky):
            written, folder = self.write(3)
        self.assertEqual(3, len(written))
        self.assertEqual(sorted(written), sorted(path.name for path in folder.iterdir()))


def scored(case="000", errors=None, **changes):
    truth = {"family": "effect", "kind": "torque", "robot": "r", "seed": 1, "foreign": None,
             "noise": {"tau": [1.0] * 6, "xyz": [3e-5, 0.0, 0.0]},
             "effects": [{"effect": "backlash", "joint": 2, "parameters": {"gap": 1e-4}}]} | changes
    result = judging.judge.blank(judging.for_the_scorer(truth))
    return judging.Scored(case, "r", result, True, True, (2,), 2, [], judging.noise_rms(truth),
                          errors or {}, {})


def constant(holdout, untrained):
    return {region: {"joint_torque": {"rms": rms, "stretches": [rms] * 20}}
            for region, rms in (("holdout", holdout), ("untrained", untrained))}


class Scoring(unittest.TestCase):
    def parameter(self, value, std=1.0, truth=0.0):
        return judging.ParameterError("000", "backlash", "gap", truth, value, std)

    def test_intervals_of_normal_errors_cover_what_they_say(self):
        draw = random.Random(2)
        right = [self.parameter(draw.gauss(0, 2.0), std=2.0) for _ in range(4000)]
        self.assertAlmostEqual(0.95, goals.coverage(right).value, delta=0.01)
        bold = [self.parameter(draw.gauss(0, 2.0), std=1.0) for _ in range(4000)]
        expected = statistics.NormalDist(0, 2).cdf(1.96) - statistics.NormalDist(0, 2).cdf(-1.96)
        self.assertAlmostEqual(expected, goals.coverage(bold).value, delta=0.02)

    def test_noise_may_be_given_by_columns(self):
        noise = judging.noise_rms({"noise": {"xyz": [3.0, 0.0, 0.0], "joint_torque": 2.0}})
        self.assertAlmostEqual(3**0.5, noise["tcp_position"])
        self.assertEqual(2.0, noise["joint_torque"])

    def test_channels_weigh_the_same_in_units_of_noise(self):
        each = scored(errors={"flexcomp": {"holdout": {
            "joint_torque": {"rms": 3.0, "stretches": []},
            "tcp_position": {"rms": 3e-5 / 3**0.5, "stretches": []}}}})
        self.assertAlmostEqual(5**0.5, each.error("flexcomp", "holdout"))

    def test_the_best_rival_of_each_case_is_the_one_to_beat(self):
        errors = {"nominal": constant(8, 8), "flexcomp": constant(1, 2), "PySINDy": constant(2, 4),
                  "boosting": constant(1, 8), "refit": constant(2, 1.5)}
        each = scored(errors=errors)
        self.assertEqual(("PySINDy", 4.0), goals.best_rival(each, "untrained"))
        self.assertEqual(0.5, goals.against_rival(each, "untrained"))

    def test_losing_to_the_refit_is_listed_and_chance_told_apart(self):
        clear = scored("001", {"flexcomp": constant(1, 2), "refit": constant(1, 1.5)})
        even = scored("002", {"flexcomp": constant(1, 1), "refit": constant(1, 1)})
        draw = random.Random(1)
        noisy = {method: constant(1, rms) for method, rms in (("flexcomp", 1.001), ("refit", 1.0))}
        for entry in noisy.values():
            entry["untrained"]["joint_torque"]["stretches"] = [
                draw.gauss(1, 0.1) for _ in range(20)]
        close = scored("003", noisy)
        lost = goals.worse_than_refit([clear, even, close])
        self.assertEqual(["001", "003"], [each.case for each, _ in lost])
        self.assertEqual([True, False], [each.beyond_chance("flexcomp", "refit", "untrained")
                                         for each, _ in lost])

    def test_only_circles_that_are_spoiled_count_in_the_loop(self):
        closed = [scored("000"), scored("001"), scored("002"), scored("003")]
        closed[0].loop = loops.Loop(9e-4, 1e-5, 1e-4, 2e-5)
        closed[1].loop = loops.Loop(9e-4, 3e-5, 1e-4, 9e-5)
        closed[2].loop = "flexcomp table: exit 2"
        found = goals.figures(closed)
        self.assertAlmostEqual(0.2, found[goals.LOOP])
        self.assertEqual(1, found["closed loops in which what is concealed spoils the circle"])
        page = loop_section.section(closed)
        self.assertIn("hardly matters", page)
        self.assertIn("flexcomp table: exit 2", page)

    def test_a_pair_is_located_by_the_finding_that_has_a_joint(self):
        place = judging._named_joint
        self.assertEqual(2, place([("wrench_scale", None), ("backlash", 2)], {"wrench_scale"}))
        self.assertIsNone(place([("wrench_scale", None), ("backlash", 2)], {"backlash"}))
        self.assertEqual(3, place([("backlash", 3), ("hysteresis", 2)], {"backlash"}))
        self.assertIsNone(place([("wrench_scale", None)], {"wrench_scale"}))
        self.assertEqual("", place([], {"backlash"}))

    def test_goals_without_a_case_are_not_judged(self):
        judged = {goal.figure: met for goal, _, met in goals.judged(goals.figures([]))}
        self.assertEqual({None}, set(judged.values()))

    def test_parameters_of_right_findings_are_compared_by_name(self):
        said = mock.Mock(named=[("backlash", 2), ("payload", None)], parameters=[
            {"gap": {"value": 1.1e-4, "std": 1e-5, "unit": "rad"}, "hold": {"value": 1, "std": 1}},
            {"mass": {"value": 3.0, "std": 1.0}}])
        effects = [{"effect": "backlash", "joint": 2, "equivalents": [],
                    "parameters": {"gap": 1e-4, "form": "load"}}]
        found = judging.parameter_errors("000", effects, said)
        self.assertEqual([("gap", 1e-4)], [(each.name, each.truth) for each in found])
        self.assertAlmostEqual(1.0, found[0].deviations)

    def test_a_parameter_without_an_interval_is_counted_apart(self):
        case = scored("000", {"flexcomp": constant(9, 9)})
        case.parameters = [judging.ParameterError("000", "payload", name, 3.0, value, std)
                           for name, value, std in (("mass", 3.1, 0.1), ("mx", 9.0, None))]
        found = goals.figures([case])
        self.assertEqual(1, found["parameters within their 95 % interval"].n)
        without = found["parameters without an interval"]
        self.assertEqual((1, 2), (without.k, without.n))

    def test_the_worst_cases_come_first(self):
        good = scored("000", {"flexcomp": constant(9, 9)})
        bad = scored("001", {"flexcomp": constant(2, 2)})
        bad.effect_right = False
        self.assertEqual(["001", "000"], [each.case for each in report.worst([good, bad])])


class Pictures(unittest.TestCase):
    def test_ticks_are_round(self):
        self.assertEqual([0, 20, 40, 60, 80, 100], [round(t) for t in svg.linear_ticks(0, 100, 5)])
        self.assertEqual([1.0, 2.0, 5.0, 10.0], svg.decades(0.9, 12))
        self.assertEqual([0.01, 0.1, 1.0, 10.0, 100.0], svg.decades(0.01, 100))

    def test_labels_are_escaped(self):
        plot = svg.Plot((0, 1), (0, 1), ("<x>", "a & b"))
        self.assertIn("&lt;x&gt;", plot.svg())
        self.assertIn("a &amp; b", plot.svg())


if __name__ == "__main__":
    unittest.main()
