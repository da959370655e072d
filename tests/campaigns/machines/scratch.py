"""A folder of its own for each test, and made-up files in it."""

import pathlib
import tempfile
import unittest

from . import synthetic
from .registry import MACHINES


class Scratch(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def written(self, name):
        """Experiments from made-up files, and what the maker of these returns."""
        reader = MACHINES[name].reader
        data = self.folder / "data" / reader.FOLDER
        truth = getattr(synthetic, name)(data)
        for file in reader.FILES:
            self.assertTrue((data / file).is_file(), file)
        return reader.write(data, self.folder / name), truth
