"""Content of the firmware image, and what is not in it: no heap, no exceptions, no run-time types, no printing
of floats, no double precision in software."""

import os
import pathlib
import re
import subprocess
import unittest

BIN = pathlib.Path(os.environ["FLEXCOMP_BIN"])
IMAGE = BIN / "flexcomp_firmware.elf"
# Ours are of the hardware (wide_conversions.cpp); the others would be software.
HARDWARE_CONVERSIONS = {"__aeabi_l2d", "__aeabi_ul2d", "__aeabi_d2ulz"}
FORBIDDEN = {
    "heap": r"_?(malloc|calloc|realloc|free|sbrk)(_r)?$|_Znwj|_Znaj|_ZdlPv|_ZdaPv|operator (new|delete)",
    "exceptions": r"__cxa_(throw|allocate_exception|begin_catch)|_Unwind|__gxx_personality|__throw_",
    "run-time types": r"^_ZTI|^_ZTS|__dynamic_cast",
    "printing and reading of floats": r"_(printf|scanf|dtoa|strtod)|^(v?s?n?printf|strtod|dtoa)",
    "double precision in software": r"__aeabi_(d|[a-z]+2d)|__(add|sub|mul|div)df3|__(fix|float)\w*df\w*",
}


def symbols(image):
    done = subprocess.run(["arm-none-eabi-nm", image], capture_output=True, text=True, check=True)
    return {line.split()[-1] for line in done.stdout.splitlines()}


class Image(unittest.TestCase):
    def test_it_contains_nothing_that_is_forbidden(self):
        there = symbols(IMAGE)
        self.assertIn("reset", there)
        for what, pattern in FORBIDDEN.items():
            with self.subTest(what=what):
                found = {name for name in there if re.search(pattern, name)} - HARDWARE_CONVERSIONS
                self.assertEqual(set(), found)

    def test_the_tests_programs_do_so_that_this_one_can_fail(self):
        there = symbols(BIN / "test_core_guard")
        self.assertTrue(any(re.search(FORBIDDEN["heap"], name) for name in there))
        self.assertTrue(any(re.search(FORBIDDEN["printing and reading of floats"], name) for name in there))

    def test_the_settings_and_the_table_have_memory_of_their_own(self):
        done = subprocess.run(["arm-none-eabi-nm", IMAGE], capture_output=True, text=True, check=True)
        address = {line.split()[-1]: int(line.split()[0], 16) for line in done.stdout.splitlines()
                   if line.split()[0] != "U"}
        self.assertLess(address["__data_load"], address["__settings_start"])
        self.assertLessEqual(address["__settings_end"], address["__table_start"])
        self.assertLess(address["__stack_guard"], address["__stack_bottom"])
        self.assertEqual(8 * 1024, address["__stack_top"] - address["__stack_bottom"])


if __name__ == "__main__":
    unittest.main()
