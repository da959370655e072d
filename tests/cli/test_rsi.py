"""The files for a KUKA's controller, and how its axes are checked."""

import json
import unittest

from command import KR270, Command, flexcomp


class Rsi(Command):
    def arguments(self, *options):
        return ["configure", "--model", KR270, "--out", self.folder / "node.toml", *options]

    def configure(self, *options):
        return self.run_well(*self.arguments("--rsi", self.folder / "kuka", *options))

    def axes(self, code):
        done = flexcomp("check", "--model", KR270, "--config", self.folder / "node.toml", "--json")
        self.assertEqual(code, done.returncode, done.stderr)
        return [each for each in json.loads(done.stdout)["checks"] if each["name"] == "config.axes"]

    def test_the_controllers_files_are_written_beside_the_nodes(self):
        self.configure("--rsi-address", "10.0.0.2:50000")
        self.assertEqual(["flexcomp.rsi.xml", "flexcomp.src", "flexcomp.xml"],
                         sorted(file.name for file in (self.folder / "kuka").iterdir()))
        node = (self.folder / "node.toml").read_text()
        ethernet = (self.folder / "kuka" / "flexcomp.xml").read_text()
        self.assertIn('rsi = "udp://10.0.0.2:50000"', node)
        type_of_node = node.split('rsi-type = "')[1].split('"')[0]
        self.assertIn(f"<SENTYPE>{type_of_node}</SENTYPE>", ethernet)
        self.assertNotIn("without-identity", node)

    def test_an_address_that_is_none_is_refused_and_nothing_written(self):
        for address in ("10.0.0.2", "10.0.0.2:0", "10.0.0.2:70000", "host:50000", "10.0.0:1", ":1", ""):
            self.assert_refused(*self.arguments("--rsi", self.folder / "kuka", "--rsi-address", address),
                                saying="--rsi-address")

    def test_check_says_how_the_axes_are_counted(self):
        self.configure()
        note, = self.axes(code=0)
        self.assertEqual("note", note["severity"])
        self.assertIn("signs 1, 1, 1, 1, 1, 1, zeros 0, 0, 0, 0, 0, 0", note["what"])

    def test_check_finds_an_axis_that_is_counted_the_other_way(self):
        self.configure()
        file = self.folder / "node.toml"
        file.write_text(file.read_text().replace("rsi-sign = [1, 1,", "rsi-sign = [1, -1,"))
        error, = self.axes(code=1)
        self.assertEqual("error", error["severity"])
        file.write_text(file.read_text().replace("[1, -1,", "[1, 1,").replace("zero = [0, 0,", "zero = [0, -90,"))
        error, = self.axes(code=1)
        self.assertIn("zeros 0, -90, 0", error["what"])


if __name__ == "__main__":
    unittest.main()
