"""The commands of the pages about the bus as they stand, and the clients that they show, on a virtual bus."""

import contextlib
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
BIN = pathlib.Path(os.environ["FLEXCOMP_BIN"])
sys.path.insert(0, str(SOURCE / "tests" / "pages"))

import pages  # noqa: E402

LEFT = 0.05  # of the circle's error, as the page says


def circularity(recording):
    done = subprocess.run([BIN / "flexcomp", "circularity", recording, "--columns", "x,z", "--json"],
                          capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["lsc"]["circularity"]


class BusPage(unittest.TestCase):
    @contextlib.contextmanager
    def followed(self, page):
        """A folder in which all commands of a page were run."""
        with tempfile.TemporaryDirectory() as name:
            workplace = pages.Workplace(name, SOURCE, os.environ["FLEXCOMP_BUILD"], BIN, with_sources=True)
            workplace.follow(pages.Page(SOURCE / page), kinds=((), ("bus",)))
            yield workplace

    def test_the_clients_in_c_and_in_python_do_what_their_pages_say(self):
        for page in ("firmware/client/README.md", "host/python/README.md"):
            with self.subTest(page=page), self.followed(page):
                pass

    def test_the_page_of_the_bus_runs_as_it_stands(self):
        with self.followed("firmware/README.md") as workplace:
            folder = workplace.folder
            workplace.run("flexcomp simulate --model host/robots/kr270/robot.yaml --path path.csv --out before.csv")
            self.assertLess(circularity(folder / "run.csv"), LEFT * circularity(folder / "before.csv"))
            with open(folder / "from-the-log.csv", newline="") as file:
                logged = sum(1 for _ in csv.reader(file))
            with open(folder / "run.csv", newline="") as file:
                self.assertGreater(logged, sum(1 for _ in csv.reader(file)))


if __name__ == "__main__":
    unittest.main()
