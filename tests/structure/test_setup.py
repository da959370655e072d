"""tools/setup, where what it needs cannot be had."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])


class Setup(unittest.TestCase):
    def test_python_packages_that_cannot_be_had_are_said_and_asked_for_again(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copytree(SOURCE / "tools", pathlib.Path(folder, "tools"))
            for _ in range(2):
                done = subprocess.run([pathlib.Path(folder, "tools", "setup"), "build"], capture_output=True,
                                      env=dict(os.environ, PIP_NO_INDEX="1", PIP_CONFIG_FILE=os.devnull),
                                      text=True, check=False)
                self.assertNotEqual(0, done.returncode)
                self.assertRegex(done.stdout, "FAIL +install cantools from PyPI")
                self.assertIn("No matching distribution found for cantools", done.stdout)


if __name__ == "__main__":
    unittest.main(verbosity=2)
