"""`simulate`, `compensate` and `table` need no search for effects."""

import os
import pathlib
import subprocess
import unittest

BIN = pathlib.Path(os.environ["FLEXCOMP_BIN"])


def symbols(program):
    return subprocess.run(["nm", "-C", program], capture_output=True, text=True, check=True).stdout


class ProgramCommands(unittest.TestCase):
    def test_they_link_no_search(self):
        self.assertIn("flexcomp::diagnosis::", symbols(BIN / "flexcomp"))
        alone = symbols(BIN / "program_commands")
        self.assertIn("flexcomp::effects::machine_of", alone)
        self.assertNotIn("flexcomp::diagnosis::", alone)

    def test_they_are_there(self):
        for command in ("simulate", "compensate", "table"):
            shown = subprocess.run([BIN / "program_commands", command, "--help"], capture_output=True,
                                   text=True, check=True).stdout
            self.assertIn("--model", shown)


if __name__ == "__main__":
    unittest.main()
