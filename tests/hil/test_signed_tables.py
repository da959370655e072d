"""Signed tables in flexcompd with a key: none older than one that has run, and a new one on trial."""

import subprocess
import time
import unittest

from bench_on_a_bus import BIN, BUS, Flexcompd, HilTest, Job, flexcomp, other_table

KEY = "3a7f0c9d51e2b8460f1d2c3b4a596877"
PERIOD = 0.01


class SignedTables(HilTest):
    def setUp(self):
        super().setUp()
        self.job = Job(self.folder, "kr270", 0.02, period=PERIOD)  # time enough to run with two tables
        self.job.be_patient()
        self.key = self.folder / "key"
        self.key.touch(0o600)
        self.key.write_text(KEY + "\n")
        self.state = self.folder / "state"
        self.state.mkdir()
        self.bus = ("--bus", f"can:{BUS}", "--key", self.key)
        other_table(self.job)
        self.sign(self.job.table, 5)

    def sign(self, table, version):
        flexcomp("table", "sign", table, "--key", self.key, "--counter", version)

    def node(self):
        node = Flexcompd(self.job, "--key", self.key, "--state-directory", self.state)
        time.sleep(0.4)  # for which it takes nothing
        return node

    def plant(self):
        """Arms it, and cuts until it is ended."""
        return subprocess.Popen(
            list(map(str, [BIN / "flexcomp", "plant", "--model", self.job.model, "--path", self.job.path, "--period",
                           PERIOD, *self.bus])), stdout=subprocess.DEVNULL)

    def send(self, version, code=0):
        """Another table, signed as this version; what is answered."""
        table = self.folder / "other.fct"
        self.sign(table, version)
        return flexcomp("node", "send-table", table, *self.bus, code=code)

    def wait_until_it_says(self, node, what):
        latest = time.monotonic() + 20
        while what not in node.messages() and time.monotonic() < latest:
            time.sleep(0.1)
        self.assertIn(what, node.messages())

    def kept(self):
        return {file.name: file.read_bytes() for file in self.state.iterdir()}

    def test_a_new_table_is_on_trial_until_the_node_has_run_with_it(self):
        with self.node() as node:
            self.assertEqual("ok\n", self.send(6))
            self.wait_until_it_says(node, "received: ok")
            node.process.kill()
        self.assertNotIn("active", self.kept())
        with self.node() as node, self.plant() as plant:
            self.wait_until_it_says(node, "starts with table version 5")
            self.wait_until_it_says(node, "has run with table version 5")
            self.assertEqual("ok\n", self.send(6))
            self.wait_until_it_says(node, "has run with table version 6")
            plant.kill()
            plant.wait()
            node.stop()
        self.assertEqual(b"6\n", self.kept()["counter"])
        with self.node() as node:
            self.wait_until_it_says(node, "starts with table version 6")
            node.stop()
        self.assertEqual(b"6\n", self.kept()["counter"])

    def test_neither_an_unsigned_table_nor_an_older_one_is_taken_also_after_a_restart(self):
        with self.node() as node:
            plain = self.folder / "plain.fct"
            plain.write_bytes(self.job.table.read_bytes()[:-24])
            self.assertIn("not signed", flexcomp("node", "send-table", plain, *self.bus, code=1))
            node.stop()
        (self.state / "counter").write_text("5\n")
        with self.node() as node:
            self.assertIn("older", self.send(4, code=1))
            forged = bytearray((self.folder / "other.fct").read_bytes())
            forged[-20] = 9  # its version
            (self.folder / "forged.fct").write_bytes(forged)
            self.assertIn("another key or of other content",
                          flexcomp("node", "send-table", self.folder / "forged.fct", *self.bus, code=1))
            self.assertEqual("ok\n", self.send(5))
            node.stop()


if __name__ == "__main__":
    unittest.main(verbosity=2)
