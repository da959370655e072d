"""Shared parts of the tests of the flexcomp command."""

import os
import pathlib
import subprocess
import tempfile
import unittest

FLEXCOMP = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "flexcomp"
SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
ROBOTS = SOURCE / "host" / "robots"
KR270 = ROBOTS / "kr270" / "robot.yaml"


made = {}  # what commands said and wrote, by their words and the path that they read


def flexcomp(*arguments):
    return subprocess.run(
        [str(FLEXCOMP), *(str(argument) for argument in arguments)], capture_output=True, text=True
    )


class Command(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.folder = pathlib.Path(self.scratch.name)

    def file(self, name, content):
        path = self.folder / name
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            path.write_text(content)
        return path

    def run_well(self, *arguments):
        done = flexcomp(*arguments)
        self.assertEqual(0, done.returncode, done.stderr)
        self.assertEqual("", done.stderr)
        return done.stdout

    def make_once(self, out, *words, path=None):
        """Runs a command well that writes `out`, and returns what it says: once for all tests that want the same."""
        key = (*map(str, words), path and path.read_bytes())
        if key not in made:
            said = self.run_well(*words, *(("--path", path) if path else ()), "--out", out)
            made[key] = said, out.read_bytes()
        said, content = made[key]
        out.write_bytes(content)
        return said

    def assert_refused(self, *arguments, saying):
        """One clear line on standard error, exit code 2, nothing left behind."""
        before = sorted(self.folder.rglob("*"))
        done = flexcomp(*arguments)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertEqual("", done.stdout)
        self.assertEqual(1, done.stderr.count("\n"), done.stderr)
        self.assertIn(saying, done.stderr)
        self.assertEqual(before, sorted(self.folder.rglob("*")))
