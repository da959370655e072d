"""The installed package serves a project that knows nothing of flexcomp's sources."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
BUILD = pathlib.Path(os.environ["FLEXCOMP_BUILD"])
PROJECT = SOURCE / "tests" / "package"


def run(*command):
    return subprocess.run(
        [str(part) for part in command], check=True, capture_output=True, text=True
    ).stdout


class InstalledPackage(unittest.TestCase):
    @unittest.skipIf(os.environ["FLEXCOMP_SANITIZED"] == "ON", "a sanitized library is not installed")
    def test_a_c_and_a_cpp_program_build_against_it_and_run(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix = pathlib.Path(folder) / "prefix"
            build = pathlib.Path(folder) / "build"
            run("cmake", "--install", BUILD, "--prefix", prefix)
            run("cmake", "-G", "Ninja", "-S", PROJECT, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}",
                "-DCMAKE_C_COMPILER=" + os.environ["FLEXCOMP_C"],
                "-DCMAKE_CXX_COMPILER=" + os.environ["FLEXCOMP_CXX"])
            run("cmake", "--build", build)
            self.assertRegex(run(build / "controller_loop"), r"^active: TCP would be off by ")
            self.assertEqual(run(build / "deflection_at_a_posture"), "1.000 mm\n")

    def test_the_readme_shows_the_program_that_is_tested(self):
        shown = re.search(r"```c\n(.*?)```", (SOURCE / "README.md").read_text(), re.DOTALL)
        self.assertIsNotNone(shown)
        self.assertEqual(shown.group(1), (PROJECT / "controller_loop.c").read_text())


if __name__ == "__main__":
    unittest.main()
