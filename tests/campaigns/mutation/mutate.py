"""Draws mutants of the core and sees which of them its tests notice; tools/mutate says more."""

import argparse
import concurrent.futures
import contextlib
import dataclasses
import io
import os
import pathlib
import queue
import random
import shutil
import subprocess
import sys

from universalmutator import mutator

SOURCE = pathlib.Path(__file__).resolve().parents[3]
BUILD = SOURCE / "build" / "mutation"
CORE = pathlib.Path("firmware") / "core"
COPIED = ("CMakeLists.txt", "include", "firmware", "tests")
RULES = ["universal.rules", "c_like.rules", "cpp.rules"]
SLOWEST_TEST = 120  # s; a mutant may never end


@dataclasses.dataclass(frozen=True)
class Mutant:
    file: str  # in firmware/core
    line: int  # from 1
    before: str
    after: str


def mutants_of(file):
    """All that the rules make of a file, but of its comments and preprocessor lines."""
    lines = (SOURCE / CORE / file).read_text().splitlines(keepends=True)
    with contextlib.redirect_stdout(io.StringIO()):
        found = mutator.mutants_regexp(lines, ruleFiles=RULES, ignorePatterns=[])
    for line, altered, *_ in found:
        before = lines[line - 1].strip()
        if before and not before.startswith(("//", "#", "}")) and altered.strip() != before:
            yield Mutant(file, line, before, altered.strip())


def run(command, timeout=None):
    """True if it ended well and in time."""
    try:
        return subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                              timeout=timeout).returncode == 0
    except subprocess.TimeoutExpired:
        return False


class Workshop:
    """A copy of the core and its tests, with a build of its own."""

    def __init__(self, number):
        self.folder = BUILD / f"copy{number}"
        self.build = self.folder / "build"
        for name in COPIED:
            origin, copy = SOURCE / name, self.folder / name
            if origin.is_dir():
                # With the time of now: what was built from a mutant is older then, and built again.
                shutil.copytree(origin, copy, dirs_exist_ok=True, copy_function=shutil.copy)
            else:
                self.folder.mkdir(parents=True, exist_ok=True)
                shutil.copy(origin, copy)
        unity = SOURCE / "build" / "third_party" / "unity"
        ready = run(["cmake", "-S", self.folder, "-B", self.build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug",
                     "-DCMAKE_CXX_FLAGS_DEBUG=-O1", "-DFLEXCOMP_BUILD_HOST=OFF", "-DFLEXCOMP_BUILD_TESTS=ON",
                     *([f"-DFETCHCONTENT_SOURCE_DIR_UNITY={unity}"] if unity.exists() else [])])
        if not (ready and self.compiles() and self.passes()):
            sys.exit(f"tools/mutate: the core does not pass its own tests in {self.folder}")

    def compiles(self):
        return run(["cmake", "--build", self.build, "--parallel", "1"])

    def passes(self):
        tests = sorted((self.build / "bin").glob("test_core_*"), key=self.place)
        return all(run([test], SLOWEST_TEST) for test in tests)

    @staticmethod
    def place(test):
        """In the order to run tests in: those that look at much, in little time, first."""
        order = ("golden_vectors", "compensator", "table_file", "compliance", "chain", "model", "guard")
        name = test.name.removeprefix("test_core_")
        return order.index(name) if name in order else len(order)

    def try_out(self, mutant):
        """"killed", "survived", or "stillborn" where it does not compile."""
        file = self.folder / CORE / mutant.file
        whole = (SOURCE / CORE / mutant.file).read_text()
        lines = whole.splitlines(keepends=True)
        lines[mutant.line - 1] = mutant.after + "\n"
        file.write_text("".join(lines))
        try:
            if not self.compiles():
                return "stillborn"
            return "survived" if self.passes() else "killed"
        finally:
            file.write_text(whole)


def judge(mutants, jobs):
    """Yields each mutant with what became of it, as it is known."""
    workshops = queue.Queue()
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for workshop in pool.map(Workshop, range(jobs)):
            workshops.put(workshop)

        def judged(mutant):
            workshop = workshops.get()
            try:
                return mutant, workshop.try_out(mutant)
            finally:
                workshops.put(workshop)
        yield from pool.map(judged, mutants)


def main():
    arguments = argparse.ArgumentParser(usage="tools/mutate [--mutants N] [--seed N] [--only NAME] [--list FILE]")
    arguments.add_argument("--mutants", type=int, default=200)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--list", type=pathlib.Path)
    arguments.add_argument("--jobs", type=int, default=os.cpu_count())
    options = arguments.parse_args()
    files = sorted((SOURCE / CORE).glob(f"{options.only}*.[ch]pp"))
    everything = [mutant for file in files for mutant in mutants_of(file.name)]
    drawn = random.Random(options.seed).sample(everything, min(options.mutants, len(everything)))
    print(f"{len(drawn)} of {len(everything)} mutants of {CORE / options.only}", flush=True)
    fates = {"killed": [], "survived": [], "stillborn": []}
    for count, (mutant, fate) in enumerate(judge(drawn, options.jobs), 1):
        fates[fate].append(mutant)
        if fate == "survived":
            print(f"  survived: {mutant.file}:{mutant.line}\n    - {mutant.before}\n    + {mutant.after}", flush=True)
        if sys.stdout.isatty():
            print(f"  {count} of {len(drawn)}", end="\r", flush=True)
    alive = len(fates["killed"]) + len(fates["survived"])
    print(f"{len(fates['killed'])} of {alive} that compile were killed"
          f" ({100 * len(fates['killed']) / max(alive, 1):.1f} %); {len(fates['stillborn'])} do not compile")
    if options.list:
        rows = [f"| `{m.file}:{m.line}` | `{m.before}` | `{m.after}` |" for m in fates["survived"]]
        options.list.write_text("\n".join(["| place | before | after |", "|---|---|---|", *rows]) + "\n")


if __name__ == "__main__":
    main()
