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
GUIDE = SOURCE / "include" / "flexcomp" / "README.md"
CONTROLLER_GUIDE = SOURCE / "firmware" / "client" / "README.md"
USAGE_OF_CONTROLLER = 2  # its exit code without arguments
KR270 = SOURCE / "host" / "robots" / "kr270" / "robot.yaml"


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
        build = self.build(PROJECT / "c_and_cpp", "-DCMAKE_CXX_COMPILER=" + os.environ["FLEXCOMP_CXX"])
        self.assertRegex(run(build / "controller_loop"), r"^active: TCP would be off by ")
        self.assertEqual(run(build / "deflection_at_a_posture"), "1.000 mm\n")

    def test_a_project_of_c_alone_needs_no_eigen_and_no_cpp_compiler(self):
        build = self.build(PROJECT / "c_alone", "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON",
                           "-DCMAKE_CXX_COMPILER=no-such-compiler")
        self.assertRegex(run(build / "controller_loop"), r"^active: TCP would be off by ")
        self.assert_is_the_controller(build / "bus_controller")

    def assert_is_the_controller(self, program):
        done = subprocess.run([program], capture_output=True, text=True, check=False)
        self.assertEqual((USAGE_OF_CONTROLLER, True), (done.returncode, done.stderr.startswith("usage: ")))

    def test_pkg_config_serves_a_c_compiler(self):
        strict = ("-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wdouble-promotion", "-Werror")
        program = self.compile_by_pkg_config("controller_loop", "flexcomp", "-std=c11", *strict)
        self.assertRegex(run(program), r"^active: TCP would be off by ")
        self.assert_is_the_controller(self.compile_by_pkg_config("bus_controller", "flexcomp_client"))

    def compile_by_pkg_config(self, name, package, *options):
        (file,) = self.prefix.rglob(f"{package}.pc")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(file.parent)}
        flags = subprocess.run(["pkg-config", "--cflags", "--libs", package], check=True, text=True,
                               capture_output=True, env=environment).stdout.split()
        self.assertNotIn(str(self.folder / "first"), " ".join(flags))
        run(os.environ["FLEXCOMP_C"], *options, PROJECT / f"{name}.c", *flags, "-o", self.folder / name)
        return self.folder / name

    def test_pkg_config_serves_a_cpp_compiler_for_whatever_processor(self):
        (package,) = self.prefix.rglob("flexcomp.pc")
        environment = {**os.environ, "PKG_CONFIG_PATH": f"{package.parent}:{os.environ.get('PKG_CONFIG_PATH', '')}"}
        flags = subprocess.run(["pkg-config", "--cflags", "--libs", "flexcomp", "eigen3"], check=True, text=True,
                               capture_output=True, env=environment).stdout.split()
        program = self.folder / "deflection_at_a_posture"
        run(os.environ["FLEXCOMP_CXX"], "-std=c++17", "-march=native", PROJECT / "deflection_at_a_posture.cpp", *flags,
            "-o", program)
        self.assertEqual(run(program), "1.000 mm\n")
        loop = self.folder / "controller_loop_in_cpp"
        run(os.environ["FLEXCOMP_CXX"], "-std=c++17", PROJECT / "controller_loop.cpp", *flags, "-o", loop)
        flexcomp, path, table = self.prefix / "bin" / "flexcomp", self.folder / "loop.csv", self.folder / "loop.fct"
        run(flexcomp, "plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--plane", "xz", "--out", path)
        run(flexcomp, "table", "--model", KR270, "--path", path, "--out", table)
        self.assertRegex(run(loop, table), r"^active: joint 2 corrected by ")

    def test_a_table_made_on_a_pc_lies_in_the_memory_of_a_program_in_c(self):
        part = GUIDE.read_text().split("## Your robot and your table\n")[1].split("\n## ")[0]
        commands = "\n".join(re.findall(r"^    (.*)$", re.sub(r"```c\n.*?```", "", part, flags=re.DOTALL), re.MULTILINE))
        (self.folder / "table_in_flash.c").write_text((PROJECT / "table_in_flash.c").read_text())
        (package,) = self.prefix.rglob("flexcomp.pc")
        environment = {**os.environ, "PKG_CONFIG_PATH": str(package.parent),
                       "PATH": f"{self.prefix / 'bin'}:{os.environ['PATH']}"}
        plan = f"flexcomp plan circle --model {KR270} --center 1.6,0,1.2 --plane xz --out path.csv\n"

        key = self.folder / "key"
        key.touch(0o600)
        key.write_text("3a7f0c9d51e2b8460f1d2c3b4a596877\n")
        sign = "flexcomp table sign t.fct --key key --counter 7\n"
        self.assertIn("\nod ", commands)

        def printed_with(fingerprint, before_it_is_copied=""):
            script = (plan + commands.replace("robot.yaml", str(KR270)).replace("0x${hash}u", fingerprint)
                      .replace("\nod ", f"\n{before_it_is_copied}od ")
                      + "\n./table_in_flash || true\n")
            done = subprocess.run(["bash", "-euc", script], cwd=self.folder, env=environment, check=True,
                                  capture_output=True, text=True)
            return done.stdout.splitlines()[-1]

        self.assertEqual("ok", printed_with("0x${hash}u"))
        self.assertEqual("ok", printed_with("0x${hash}u", sign))
        self.assertEqual("ok", printed_with("0x${hash}u", "truncate --size=65536 t.fct\n"))
        self.assertEqual("the table was made for another robot, tool or payload", printed_with("0x1u"))

    def test_a_robot_is_written_as_a_model_in_c_with_its_fingerprint(self):
        for robot in ("kr270", "kr500"):
            source = KR270.parents[1] / robot / "robot.yaml"
            run(self.prefix / "bin" / "flexcomp", "configure", "--model", source, "--out", self.folder / "node.toml",
                "--c-model", self.folder / "robot_model.h")
            configured = re.search(r'^model-hash = "(.*)"$', (self.folder / "node.toml").read_text(), re.MULTILINE)
            for language, compiler, standard in (("c", "FLEXCOMP_C", "-std=c11"), ("c++", "FLEXCOMP_CXX", "-std=c++17")):
                (package,) = self.prefix.rglob("flexcomp.pc")
                flags = subprocess.run(["pkg-config", "--cflags", "--libs", "flexcomp"], check=True, text=True,
                                       capture_output=True,
                                       env={**os.environ, "PKG_CONFIG_PATH": str(package.parent)}).stdout.split()
                run(os.environ[compiler], standard, "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-I", self.folder, "-x",
                    language, PROJECT / "fingerprint.c", "-x", "none", *flags, "-o", self.folder / "fingerprint")
                self.assertEqual([configured.group(1)] * 2, run(self.folder / "fingerprint").split())

    def test_the_guide_shows_the_programs_that_are_tested(self):
        shown = re.findall(r"```c\n(.*?)```", GUIDE.read_text(), re.DOTALL)
        self.assertEqual([(PROJECT / name).read_text() for name in ("controller_loop.c", "table_in_flash.c")], shown)
        shown = re.findall(r"```cpp\n(.*?)```", GUIDE.read_text(), re.DOTALL)
        self.assertEqual([(PROJECT / "controller_loop.cpp").read_text()], shown)
        shown = re.findall(r"```c bus_controller.c\n(.*?)```", CONTROLLER_GUIDE.read_text(), re.DOTALL)
        self.assertEqual([(PROJECT / "bus_controller.c").read_text()], shown)

    def test_no_page_is_installed_among_the_headers(self):
        self.assertEqual([], list(self.prefix.rglob("*.md")))


if __name__ == "__main__":
    unittest.main()
