"""Includes that are allowed: the core takes nothing of the firmware, the firmware nothing of the host, no room its
own users; and files that stay short."""

import graphlib
import os
import pathlib
import re
import unittest

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
FLOORS = ("include", "firmware", "host")  # each stands on those before it
LONGEST = 400  # lines of a file of the host
INCLUDE = re.compile(r'^#include "([^"]+)"', re.MULTILINE)


def sources(source):
    """Texts of all files by their paths within the project."""
    return {str(path.relative_to(source)): path.read_text()
            for floor in FLOORS for path in sorted((source / floor).rglob("*"))
            if path.suffix in (".cpp", ".hpp", ".h", ".c", ".inc")}


def includes(texts):
    """(file, the file that it includes), of files of the project."""
    for file, text in texts.items():
        for name in INCLUDE.findall(text):
            for floor in FLOORS:
                if f"{floor}/{name}" in texts:
                    yield file, f"{floor}/{name}"


def room_of(file):
    """Its floor, and the folder on it: host/diagnosis."""
    parts = file.split("/")
    return "/".join(parts[:2]) if len(parts) > 2 else parts[0]


def upward(texts):
    return [f"{file} includes {other}" for file, other in includes(texts)
            if FLOORS.index(other.split("/")[0]) > FLOORS.index(file.split("/")[0])]


def circle(edges):
    """A circle in (from, to) pairs, or nothing."""
    sorter = graphlib.TopologicalSorter()
    for one, other in edges:
        if one != other:
            sorter.add(one, other)
    try:
        sorter.prepare()
    except graphlib.CycleError as error:
        return error.args[1]
    return []


class Includes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.texts = sources(SOURCE)

    def test_no_floor_includes_what_stands_on_it(self):
        self.assertEqual([], upward(self.texts))

    def test_rooms_do_not_include_each_other_in_a_circle(self):
        self.assertEqual([], circle((room_of(a), room_of(b)) for a, b in includes(self.texts)))

    def test_files_do_not_include_each_other_in_a_circle(self):
        self.assertEqual([], circle(includes(self.texts)))

    def test_no_file_of_the_host_is_long(self):
        lengths = {file: text.count("\n") for file, text in self.texts.items() if file.startswith("host/")}
        self.assertEqual({}, {file: length for file, length in lengths.items() if length > LONGEST})

    def test_this_sees_what_it_looks_for(self):
        lower = {"firmware/node/a.hpp": '#include "study/b.hpp"\n', "host/study/b.hpp": "", "host/x/c.hpp": ""}
        self.assertEqual(["firmware/node/a.hpp includes host/study/b.hpp"], upward(lower))
        round_about = {"host/study/b.hpp": '#include "x/c.hpp"\n', "host/x/c.hpp": "",
                       "host/x/d.hpp": '#include "study/b.hpp"\n'}
        self.assertEqual([], circle(includes(round_about)))
        self.assertTrue(circle((room_of(a), room_of(b)) for a, b in includes(round_about)))
        self.assertGreater(len(list(includes(self.texts))), 500)


if __name__ == "__main__":
    unittest.main()
