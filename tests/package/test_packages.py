"""The Debian packages, unpacked into a root of their own: everything is where it belongs, and serves from there."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
BUILD = pathlib.Path(os.environ["FLEXCOMP_BUILD"])
PROJECT = SOURCE / "tests" / "package"
NAMES = ("flexcomp", "flexcompd", "libflexcomp-dev")
CIRCLE = """
robot=$root/usr/share/flexcomp/robots/kr270/robot.yaml
flexcomp plan circle --model $robot --center 1.6,0,1.2 --plane xz --out path.csv
flexcomp table --model $robot --path path.csv --tolerance 1e-6 --out t.fct
flexcomp compensate --model $robot --table t.fct --path path.csv --out corrected.csv
flexcomp simulate --model $robot --path corrected.csv --out after.csv
flexcomp circularity after.csv --columns x,z
flexcomp configure --model $robot --table t.fct --period 0.004 --out node.toml
flexcompd --config node.toml --settings-out settings.bin
"""


def run(*command, **more):
    done = subprocess.run([str(part) for part in command], text=True, check=False, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, **more)
    if done.returncode != 0:
        raise AssertionError(f"exit code {done.returncode} of {command}:\n{done.stdout}")
    return done.stdout


class Packages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        # Quickly: how small a package becomes is not tested.
        run("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder / "packages",
            "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")
        cls.packages = {}
        for file in (cls.folder / "packages").glob("*.deb"):
            cls.packages[run("dpkg-deb", "--field", file, "Package").strip()] = file
        cls.root = cls.folder / "root"
        for file in cls.packages.values():
            run("dpkg-deb", "--extract", file, cls.root)
        cls.environment = dict(os.environ, root=str(cls.root), PATH=f"{cls.root}/usr/bin:{os.environ['PATH']}")

    def files(self, package):
        listed = run("dpkg-deb", "--contents", self.packages[package]).splitlines()
        return {line.split()[5].removeprefix(".") for line in listed if not line.startswith("d")}

    def field(self, package, name):
        return run("dpkg-deb", "--field", self.packages[package], name).strip()

    def place(self, pattern):
        (path,) = self.root.glob(pattern)
        return path

    def test_there_are_three_and_no_file_is_in_two(self):
        self.assertEqual(set(NAMES), set(self.packages))
        every = [file for name in NAMES for file in self.files(name)]
        self.assertEqual(sorted(set(every)), sorted(every))

    def test_each_has_what_belongs_to_it(self):
        expected = {
            "flexcomp": ("/usr/bin/flexcomp", "/usr/share/flexcomp/robots/kr500/robot.yaml",
                         "/usr/share/man/man1/flexcomp.1", "/usr/share/bash-completion/completions/flexcomp"),
            "flexcompd": ("/usr/bin/flexcompd", "/usr/lib/systemd/system/flexcompd.service",
                          "/usr/lib/sysusers.d/flexcompd.conf", "/usr/share/flexcomp/messages/flexcomp.dbc",
                          "/usr/share/flexcomp/messages/wrench.lcm", "/usr/share/man/man8/flexcompd.8",
                          "/usr/share/bash-completion/completions/flexcompd"),
            "libflexcomp-dev": ("/usr/include/flexcomp/flexcomp.h", "/usr/include/flexcomp/compensator.hpp")}
        for name, files in expected.items():
            with self.subTest(name):
                self.assertEqual(set(), {*files, f"/usr/share/doc/{name}/copyright"} - self.files(name))
                self.assertEqual([], [file for file in self.files(name) if not file.startswith("/usr/")])
        for pattern in ("libflexcomp_core.a", "flexcomp.pc", "flexcomp-config.cmake"):
            self.assertTrue(any(file.endswith(f"/{pattern}") for file in self.files("libflexcomp-dev")), pattern)

    def test_programs_say_which_libraries_they_need_and_the_library_needs_none(self):
        for name in ("flexcomp", "flexcompd"):
            self.assertRegex(self.field(name, "Depends"), r"\blibc6 \(>= .*\blibfmt")
        self.assertRegex(self.field("flexcomp", "Depends"), r"\bgnuplot-nox\b")
        self.assertEqual("", self.field("libflexcomp-dev", "Depends"))

    def test_a_circle_is_corrected_from_there(self):
        said = run("bash", "-euc", CIRCLE, cwd=self.folder, env=self.environment)
        self.assertRegex(said, r"LSC")
        self.assertTrue((self.folder / "settings.bin").stat().st_size > 0)

    def test_the_unit_starts_the_program_of_the_package_as_a_user_that_is_made(self):
        unit = (self.root / "usr/lib/systemd/system/flexcompd.service").read_text()
        program, user = re.search(r"^ExecStart=(\S+)", unit, re.M).group(1), re.search(r"^User=(\S+)", unit, re.M).group(1)
        self.assertIn(program, self.files("flexcompd"))
        self.assertRegex((self.root / "usr/lib/sysusers.d/flexcompd.conf").read_text(), rf"(?m)^u {user} ")
        control = self.folder / "control"
        run("dpkg-deb", "--control", self.packages["flexcompd"], control)
        self.assertTrue(os.access(control / "postinst", os.X_OK))

    def test_the_pages_tell_every_subcommand_and_option(self):
        page = self.place("usr/share/man/man1/flexcomp.1").read_text()
        for words in ("FLEXCOMP TABLE VERIFY", "FLEXCOMP DIAGNOSE"):
            self.assertIn(f'.SH "{words}"', page)
        self.assertIn("\\-\\-orientation\\-tolerance", page)

    def test_the_shell_completes_subcommands_and_options(self):
        completions = self.root / "usr/share/bash-completion/completions/flexcomp"
        for words, expected in ((("dia",), "diagnose"), (("table", "veri"), "verify"), (("table", "--tole"), "--tolerance"),
                                (("help", "table", "veri"), "verify"), (("he",), "help")):
            done = run("bash", "-euc", 'source "$0"; COMP_WORDS=(flexcomp "$@"); COMP_CWORD=$#; _flexcomp; echo "${COMPREPLY[*]}"',
                       completions, *words)
            self.assertEqual(expected, done.strip())

    def test_a_program_in_c_builds_against_the_library_without_eigen(self):
        package = self.place("usr/**/pkgconfig/flexcomp.pc")
        flags = run("pkg-config", "--cflags", "--libs", "flexcomp",
                    env=dict(os.environ, PKG_CONFIG_LIBDIR=str(package.parent))).split()
        self.assertEqual([], [flag for flag in flags if flag.startswith("-I") and "eigen" in flag.lower()])
        program = self.folder / "controller_loop"
        run(os.environ["FLEXCOMP_C"], "-std=c11", PROJECT / "controller_loop.c", *flags, "-o", program)
        self.assertRegex(run(program), r"^active: TCP would be off by ")


if __name__ == "__main__":
    unittest.main(verbosity=2)
