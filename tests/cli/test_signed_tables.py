"""Signed tables: what flexcomp makes, and what flexcompd --key starts with. Needs no bus: flexcompd reads
its table before it opens one, and there is none."""

import json
import subprocess
import unittest

from command import FLEXCOMP, KR270, Command, flexcomp

KEY = "3a7f0c9d51e2b8460f1d2c3b4a596877"
OTHER_KEY = "00112233445566778899aabbccddeeff"
TRAILER = 24


def openssl_cmac(content):
    """Computed by another library than ours."""
    done = subprocess.run(["openssl", "mac", "-cipher", "AES-128-CBC", "-macopt", f"hexkey:{KEY}", "CMAC"],
                          input=content, capture_output=True, check=True)
    return bytes.fromhex(done.stdout.decode())


class Signed(Command):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "path.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--plane", "xz",
                      "--points", 60, "--out", self.path)
        self.key = self.key_file("key", KEY)
        self.table = self.make("plain.fct")

    def key_file(self, name, digits):
        path = self.file(name, digits + "\n")
        path.chmod(0o600)
        return path

    def make(self, name, *options):
        table = self.folder / name
        self.run_well("table", "--model", KR270, "--path", self.path, "--tolerance", 1e-5, "--out", table,
                      *options)
        return table

    def signed(self, counter, key=None):
        out = self.folder / f"version-{counter}.fct"
        self.run_well("table", "sign", self.table, "--key", key or self.key, "--counter", counter, "--out", out)
        return out


class Making(Signed):
    def test_a_signed_table_is_the_same_table_with_a_trailer_that_openssl_agrees_with(self):
        plain = self.table.read_bytes()
        content = self.make("signed.fct", "--key", self.key, "--counter", 7).read_bytes()
        self.assertEqual(plain + b"FCS1" + (7).to_bytes(4, "little"), content[:-16])
        self.assertEqual(openssl_cmac(content[:-16]), content[-16:])
        self.assertEqual(content, self.signed(7).read_bytes())

    def test_signing_again_replaces_the_signature(self):
        self.run_well("table", "sign", self.table, "--key", self.key, "--counter", 3)
        self.run_well("table", "sign", self.table, "--key", self.key, "--counter", 7)
        self.assertEqual(self.signed(7).read_bytes(), self.table.read_bytes())

    def test_every_command_that_takes_a_table_takes_a_signed_one(self):
        table = self.signed(7)
        for name, file in (("plain.csv", self.table), ("signed.csv", table)):
            self.run_well("compensate", "--model", KR270, "--table", file, "--path", self.path,
                          "--out", self.folder / name)
        self.assertEqual((self.folder / "plain.csv").read_bytes(), (self.folder / "signed.csv").read_bytes())
        self.run_well("configure", "--model", KR270, "--table", table, "--out", self.folder / "node.toml")

    def test_verify_checks_the_signature(self):
        verify = ("table", "verify", "--model", KR270, "--samples", 10, "--key", self.key)
        self.assertEqual(7, json.loads(self.run_well(*verify, "--json", self.signed(7)))["signed_version"])
        self.assert_refused(*verify, self.table, saying="not signed")
        self.assert_refused(*verify, self.signed(8, self.key_file("other", OTHER_KEY)), saying="another key")
        content = bytearray(self.signed(7).read_bytes())
        content[-TRAILER + 4] += 1
        self.assert_refused(*verify, self.file("raised.fct", bytes(content)), saying="other content")

    def test_bad_arguments_get_one_line(self):
        out = self.folder / "out.fct"
        build = ("table", "--model", KR270, "--path", self.path, "--out", out)
        self.assert_refused(*build, "--key", self.key, saying="--counter")
        self.assert_refused(*build, "--counter", 3, saying="--key")
        self.assert_refused("table", "sign", self.table, saying="--key")
        self.assert_refused("table", "sign", self.path, "--key", self.key, "--counter", 1, saying="not a flexcomp")
        for counter in (-1, 2**32, "x"):
            self.assert_refused("table", "sign", self.table, "--key", self.key, "--counter", counter,
                                saying="--counter")
        self.assert_refused("table", "sign", self.table, "--key", self.path, "--counter", 1, saying=str(self.path))


class Starting(Signed):
    """Tables that flexcompd takes; it ends there, or where it would open the bus."""

    def said(self, table, *options, key=True):
        model_hash = json.loads(flexcomp("table", "verify", self.table, "--model", KR270, "--samples", 1,
                                         "--json").stdout)["model_hash"]
        done = subprocess.run([str(FLEXCOMP.with_name("flexcompd")), "--model-hash", model_hash, "--can", "nocan7",
                               "--table", str(table), *(("--key", str(self.key)) if key else ()),
                               *map(str, options)], capture_output=True, text=True, timeout=20)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertEqual(1, done.stderr.count("\n"), done.stderr)
        return done.stderr

    def test_with_a_key_only_a_table_signed_with_it_is_taken(self):
        self.assertIn("nocan7", self.said(self.signed(7)))
        self.assertIn("not signed", self.said(self.table))
        self.assertIn("another key", self.said(self.signed(7, self.key_file("other", OTHER_KEY))))

    def test_without_a_key_either_is_taken(self):
        for table in (self.table, self.signed(7)):
            self.assertIn("nocan7", self.said(table, key=False))

    def test_no_table_older_than_one_that_has_run_is_taken(self):
        state = self.folder / "state"
        state.mkdir()
        (state / "counter").write_text("7\n")
        for counter, expected in ((6, "older"), (7, "nocan7"), (8, "nocan7")):
            self.assertIn(expected, self.said(self.signed(counter), "--state-directory", state))
        (state / "counter").write_text("seven\n")
        self.assertIn("counter", self.said(self.signed(8), "--state-directory", state))

    def test_a_kept_table_that_is_not_confirmed_or_not_signed_is_not_started_with(self):
        state = self.folder / "state"
        state.mkdir()
        (state / "table-a.fct").write_bytes(self.signed(7).read_bytes())
        self.assertIn("not signed", self.said(self.table, "--state-directory", state))
        (state / "active").write_text("table-a.fct")
        self.assertIn("nocan7", self.said(self.table, "--state-directory", state))


if __name__ == "__main__":
    unittest.main()
