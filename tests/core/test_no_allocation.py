"""The core and the controller's side of the bus refer to no allocator, exception or RTTI symbol: natively
and on the Cortex-M7.

Linked whole, it may need nothing from outside but these few functions of the C library.
"""

import os
import pathlib
import subprocess
import tempfile
import unittest

COMPILER = os.environ["FLEXCOMP_CXX"]
PREFIX = "arm-none-eabi-" if "arm-none-eabi-" in COMPILER else ""
CROSS = ["-mcpu=cortex-m7", "-mfpu=fpv5-d16", "-mfloat-abi=hard", "-mthumb"] if PREFIX else []
# In one partition: linked to an object file in several, GCC 12 may end by an internal error.
OPTIMISED_WHEN_LINKED = ["-O2", "-flto", "-flto-partition=one", "-flinker-output=nolto-rel"] if PREFIX else []
ALLOWED = {
    "memcpy", "memmove", "memset", "memcmp", "_GLOBAL_OFFSET_TABLE_",
    "atan2", "atan2f", "cos", "cosf", "sin", "sinf", "sincos", "sincosf", "sqrt", "sqrtf",
    "expm1", "expm1f", "ceil", "ceilf", "floor", "floorf", "nextafterf", "round",
}
LIBRARY_CALLS = ("__aeabi_",)  # integer division and the like on the Cortex-M7: no memory
HEAP = {"malloc", "free", "_malloc_r", "_sbrk", "_sbrk_r", "abort", "__cxa_throw"}
HEAP_OR_RUN_TIME_TYPES = ("_Znw", "_Zna", "_Zdl", "_Zda", "_ZTI", "_ZTV")


def run(*command):
    return subprocess.run([str(part) for part in command], check=True, capture_output=True, text=True).stdout


def names(file, *options):
    return {line.split()[-1] for line in run(PREFIX + "nm", *options, file).splitlines()}


class CoreSymbols(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        cls.core = cls.folder / "core.o"
        run(COMPILER, *CROSS, *OPTIMISED_WHEN_LINKED, "-r", "-nostdlib", "-Wl,--whole-archive",
            os.environ["FLEXCOMP_CORE"], *os.environ["FLEXCOMP_CLIENT"].split(), "-o", cls.core)

    def test_it_needs_only_mathematics_and_memory_copies(self):
        needed = {name for name in names(self.core, "--undefined-only") if not name.startswith(LIBRARY_CALLS)}
        self.assertEqual(set(), needed - ALLOWED)
        self.assertIn("expm1f", needed)
        there = names(self.core, "--defined-only")
        self.assertIn("flexcomp_compensator_tick", there)
        self.assertEqual(bool(os.environ["FLEXCOMP_CLIENT"]), "flexcomp_client_receive" in there)

    @unittest.skipUnless(PREFIX, "a program of a PC's C library has a heap in any case")
    def test_a_program_of_all_of_it_has_no_heap(self):
        program = self.folder / "program.elf"
        entry = self.folder / "entry.c"
        entry.write_text("void _start(void) {}\n")
        run(COMPILER, *CROSS, "-nostartfiles", "--specs=nano.specs", "-x", "c", entry, "-x", "none", self.core,
            "-lm", "-o", program)
        there = names(program)
        self.assertTrue("flexcomp_compensator_tick" in there)
        self.assertEqual(set(), {name for name in there
                                 if name in HEAP or name.startswith(HEAP_OR_RUN_TIME_TYPES)})


if __name__ == "__main__":
    unittest.main()
