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


@unittest.skipIf(os.environ["FLEXCOMP_SANITIZED"] == "ON", "a sanitized library is not installed")
class InstalledPackage(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)
        installed = self.folder / "first"
        run("cmake", "--install", BUILD, "--prefix", installed)
        self.prefix = self.folder / "moved"
        installed.rename(self.prefix)

    def build(self, project, *options):
        build = self.folder / "build"
        run("cmake", "-G", "Ninja", "-S", project, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}",
            "-DCMAKE_C_COMPILER=" + os.environ["FLEXCOMP_C"], *options)
        run("cmake", "--build", build)
        return build

    def test_a_c_and_a_cpp_program_build_against_it_and_run(self):
        build = self.build(PROJECT, "-DCMAKE_CXX_COMPILER=" + os.environ["FLEXCOMP_CXX"])
        self.assertRegex(run(build / "controller_loop"), r"^active: TCP would be off by ")
        self.assertEqual(run(build / "deflection_at_a_posture"), "1.000 mm\n")

    def test_a_project_of_c_alone_needs_no_eigen_and_no_cpp_compiler(self):
        build = self.build(PROJECT / "c_alone", "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON",
                           "-DCMAKE_CXX_COMPILER=no-such-compiler")
        self.assertRegex(run(build / "controller_loop"), r"^active: TCP would be off by ")

    def test_pkg_config_serves_a_c_compiler(self):
        (package,) = self.prefix.rglob("flexcomp.pc")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(package.parent)}
        flags = subprocess.run(["pkg-config", "--cflags", "--libs", "flexcomp"], check=True, text=True,
                               capture_output=True, env=environment).stdout.split()
        self.assertNotIn(str(self.folder / "first"), " ".join(flags))
        program = self.folder / "controller_loop"
        run(os.environ["FLEXCOMP_C"], "-std=c11", PROJECT / "controller_loop.c", *flags, "-o", program)
        self.assertRegex(run(program), r"^active: TCP would be off by ")

    def test_the_guide_shows_the_program_that_is_tested(self):
        shown = re.search(r"```c\n(.*?)```", (SOURCE / "include/flexcomp/README.md").read_text(), re.DOTALL)
        self.assertIsNotNone(shown)
        self.assertEqual(shown.group(1), (PROJECT / "controller_loop.c").read_text())


if __name__ == "__main__":
    unittest.main()
