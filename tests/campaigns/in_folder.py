"""A folder of its own for each test of a campaign."""

import pathlib
import tempfile
import unittest


class InFolder(unittest.TestCase):
    def setUp(self):
        kept = tempfile.TemporaryDirectory()
        self.addCleanup(kept.cleanup)
        self.folder = pathlib.Path(kept.name)
