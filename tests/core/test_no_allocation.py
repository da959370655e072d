"""The core refers to no allocator, exception or RTTI symbol: natively and on the Cortex-M7.

Linked whole, it may need nothing from outside but these few functions of the C library.
"""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
ALLOWED = {
    "memcpy", "memmove", "memset", "memcmp", "_GLOBAL_OFFSET_TABLE_",
    "atan2", "atan2f", "cos", "cosf", "sin", "sinf", "sincos", "sincosf", "sqrt", "sqrtf",
    "expm1", "expm1f", "ceil", "ceilf", "floor", "floorf", "nextafterf",
}
CORTEX_M7 = ["-mcpu=cortex-m7", "-mfpu=fpv5-d16", "-mfloat-abi=hard", "-mthumb"]
ARM_LIBRARY_CALLS = ("__aeabi_",)  # integer division and the like: no memory


def run(*command):
    return subprocess.run(
        [str(part) for part in command], check=True, capture_output=True, text=True
    ).stdout


def needed_from_outside(nm, archive):
    needed = set()
    provided = set()
    for line in run(nm, archive).splitlines():
        fields = line.split()
        if len(fields) >= 2 and fields[-2] in {"U", "w", "v"}:
            needed.add(fields[-1])
        elif len(fields) == 3:
            provided.add(fields[-1])
    return needed - provided


class CoreSymbols(unittest.TestCase):
    @unittest.skipUnless(os.environ["FLEXCOMP_BUILD_TYPE"] == "Release", "debug builds have assertions")
    def test_the_native_archive_needs_only_mathematics_and_memory_copies(self):
        needed = needed_from_outside("nm", os.environ["FLEXCOMP_CORE"])
        self.assertEqual(set(), needed - ALLOWED)
        self.assertIn("expm1f", needed)

    @unittest.skipUnless(shutil.which("arm-none-eabi-g++"), "arm-none-eabi-g++ is not installed")
    def test_the_cortex_m7_archive_needs_only_mathematics_and_memory_copies(self):
        with tempfile.TemporaryDirectory() as folder:
            objects = []
            for source in sorted((SOURCE / "firmware" / "core").glob("*.cpp")):
                objects.append(pathlib.Path(folder) / (source.stem + ".o"))
                run("arm-none-eabi-g++", *CORTEX_M7, "-std=c++17", "-Os", "-DNDEBUG",
                    "-fno-exceptions", "-fno-rtti", "-Wall", "-Wextra", "-Werror",
                    '-DFLEXCOMP_VERSION="test"', "-I", SOURCE / "include",
                    "-isystem", os.environ["FLEXCOMP_EIGEN"], "-c", source, "-o", objects[-1])
            archive = pathlib.Path(folder) / "libcore.a"
            run("arm-none-eabi-ar", "rcs", archive, *objects)
            needed = {
                name for name in needed_from_outside("arm-none-eabi-nm", archive)
                if not name.startswith(ARM_LIBRARY_CALLS)
            }
            self.assertEqual(set(), needed - ALLOWED)
            self.link_whole(folder, archive)

    def link_whole(self, folder, archive):
        """Links every object of the archive and looks for a heap in the result."""
        program = pathlib.Path(folder) / "program.elf"
        entry = pathlib.Path(folder) / "entry.c"
        entry.write_text("void _start(void) {}\n")
        run("arm-none-eabi-g++", *CORTEX_M7, "-nostartfiles", "--specs=nano.specs", "-x", "c", entry,
            "-x", "none", "-Wl,--whole-archive", archive, "-Wl,--no-whole-archive", "-o", program)
        symbols = {line.split()[-1] for line in run("arm-none-eabi-nm", program).splitlines()}
        heap = {name for name in symbols
                if name in {"malloc", "free", "_malloc_r", "_sbrk", "_sbrk_r", "abort", "__cxa_throw"}
                or name.startswith(("_Znw", "_Zna", "_Zdl", "_Zda", "_ZTI", "_ZTV"))}
        self.assertEqual(set(), heap)


if __name__ == "__main__":
    unittest.main()
