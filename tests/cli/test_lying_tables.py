"""Tables whose content was altered and whose checksum was made anew: anyone can find that out."""

import json
import struct
import unittest
import zlib

from command import KR270, Command, flexcomp

# Words of the header (include/flexcomp/table.hpp).
FIELDS = {name: 4 * word for word, name in enumerate(
    ["magic", "version", "size", "crc", "hash_low", "hash_high", "chart", "contents", "joints", "record_size",
     "node_count", "closed", "grid_axes"]
    + [f"grid_joint_{i}" for i in range(4)] + [f"grid_nodes_{i}" for i in range(4)]
    + [f"grid_lower_{i}" for i in range(4)] + [f"grid_step_{i}" for i in range(4)]
    + [f"fixed_angle_{i}" for i in range(6)] + [f"first_axis_{i}" for i in range(3)]
    + [f"joint_lower_{i}" for i in range(6)] + [f"joint_upper_{i}" for i in range(6)]
    + [f"compliance_{i}" for i in range(6)] + [f"cubic_compliance_{i}" for i in range(6)]
    + ["force_bound", "moment_bound", "position_error", "orientation_error", "largest_gain"])}
HEADER_BYTES = 268
PROCESS = ("--depth-of-cut", "2e-3")


class LyingTables(Command):
    @classmethod
    def setUpClass(cls):
        assert FIELDS["largest_gain"] == HEADER_BYTES - 4

    def setUp(self):
        super().setUp()
        self.path = self.folder / "path.csv"
        self.make_once(self.path, "plan", "circle", "--model", KR270, "--center", "1.6,0,1.2", "--plane", "xz",
                       "--points", "60")
        self.true = self.folder / "t.fct"
        self.make_once(self.true, "table", "--model", KR270, *PROCESS, path=self.path)

    def lie(self, **altered):
        content = bytearray(self.true.read_bytes())
        for name, change in altered.items():
            (number,) = struct.unpack_from("<f", content, FIELDS[name])
            struct.pack_into("<f", content, FIELDS[name], change(number))
        struct.pack_into("<I", content, FIELDS["crc"], 0)
        struct.pack_into("<I", content, FIELDS["crc"], zlib.crc32(bytes(content)))
        return self.file("lie.fct", bytes(content))

    def verify(self, table, *more):
        return flexcomp("table", "verify", table, "--model", KR270, "--samples", "200", *more)

    def compensate(self, table):
        return flexcomp("compensate", "--model", KR270, "--table", table, "--path", self.path, "--out",
                        self.folder / "out.csv")

    def test_a_true_table_holds(self):
        told = self.verify(self.true)
        self.assertEqual(0, told.returncode, told.stderr)
        self.assertRegex(told.stdout, r"largest safe gain: +\S+, as follows from a cut 2 mm deep, .*ticks every 4 ms")
        self.assertIn("holds on the chords", told.stdout)
        self.assertNotIn("NOT", told.stdout)
        told = self.verify(self.true, "--path", self.path, *PROCESS)
        self.assertEqual(0, told.returncode, told.stdout + told.stderr)
        self.assertNotIn("NOT", told.stdout)

    def test_springs_and_limits_that_lie_are_refused_by_verify_and_by_compensate(self):
        for name in ("compliance", "joint_lower", "joint_upper"):
            for factor in (-1, 5, 0, 1e30, 1.0000002):
                with self.subTest(field=name, factor=factor):
                    lie = self.lie(**{f"{name}_{i}": lambda number: factor * number for i in range(6)})
                    for told in (self.verify(lie), self.compensate(lie)):
                        self.assertEqual(2, told.returncode, told.stdout)
                        self.assertRegex(told.stderr, r"\A[^\n]*lie\.fct: bears the model's fingerprint, but[^\n]*\n\Z")
                        self.assertFalse((self.folder / "out.csv").exists())

    def test_bounds_that_lie_are_refused(self):
        for name, value, code in (("force_bound", -1730, 2), ("moment_bound", -12, 2), ("force_bound", 1e30, 1),
                                  ("position_error", 1e30, 2), ("position_error", 1e-9, 1),
                                  ("position_error", -1e-6, 2), ("orientation_error", 1e30, 2),
                                  ("orientation_error", 1e-12, 1), ("largest_gain", -1, 2)):
            with self.subTest(field=name, value=value):
                lie = self.lie(**{name: lambda _: value})
                told = self.verify(lie)
                self.assertEqual(code, told.returncode, told.stdout + told.stderr)
                if code == 1:
                    self.assertIn("DOES NOT HOLD", told.stdout)
                self.assertEqual(2, self.compensate(lie).returncode)

    def test_a_largest_gain_that_does_not_follow_from_the_process_beside_it_is_refused(self):
        for change in (lambda gain: 5 * gain, lambda gain: 0, lambda gain: 1000.0, lambda gain: 0.9 * gain):
            lie = self.lie(largest_gain=change)
            for told in (self.verify(lie), self.compensate(lie),
                         flexcomp("configure", "--model", KR270, "--table", lie, "--out", self.folder / "node.toml")):
                self.assertEqual(2, told.returncode, told.stdout + told.stderr)
                self.assertIn("does not follow from the process beside it", told.stderr)

    def test_a_process_that_is_not_yours_does_not_hold(self):
        told = self.verify(self.true, "--path", self.path, "--depth-of-cut", "1e-3")
        self.assertEqual(1, told.returncode, told.stdout + told.stderr)
        self.assertIn("NOT THE SAME", told.stdout)

    def test_widths_that_let_in_more_than_is_stated_do_not_hold(self):
        content = self.true.read_bytes()
        (size,) = struct.unpack_from("<I", content, FIELDS["record_size"])
        (nodes,) = struct.unpack_from("<I", content, FIELDS["node_count"])
        widths = {f"width_{node}": HEADER_BYTES + 4 * (node * size + 24) for node in range(nodes)}
        FIELDS.update(widths)
        lie = self.lie(**{name: lambda width: 1.3 * width for name in widths})
        told = self.verify(lie)
        self.assertEqual(1, told.returncode, told.stdout + told.stderr)
        self.assertRegex(told.stdout, r"bound at all angles it takes: .*DOES NOT HOLD")
        self.assertEqual(2, self.compensate(lie).returncode)

    def test_an_older_table_is_used_but_not_vouched_for_without_its_program(self):
        nothing = {name: lambda _: 0 for name in [f"fixed_angle_{i}" for i in range(6)] + ["grid_lower_0", "grid_lower_1"]}
        older = self.lie(**nothing)
        told = self.verify(older)
        self.assertEqual(1, told.returncode, told.stdout + told.stderr)
        self.assertEqual(2, told.stdout.count("NOT CHECKED: an older flexcomp made the table"))
        told = self.verify(older, "--path", self.path, *PROCESS)
        self.assertEqual(0, told.returncode, told.stdout + told.stderr)
        self.assertEqual(0, self.compensate(older).returncode)

    def test_records_that_lie_do_not_hold(self):
        content = self.true.read_bytes()
        (size,) = struct.unpack_from("<I", content, FIELDS["record_size"])
        for part, offset in (("angle", 1), ("switching plane", 6 + 1), ("plane in", 12 + 1), ("plane out", 18 + 1),
                             ("Jacobian", 25 + 8)):
            for change in (lambda number: -number, lambda number: 5 * number + 0.1):
                with self.subTest(part):
                    FIELDS["record"] = HEADER_BYTES + 4 * (3 * size + offset)
                    lie = self.lie(record=change)
                    self.assertIn(self.verify(lie).returncode, (1, 2))
                    self.assertEqual(2, self.compensate(lie).returncode)

    def test_a_program_that_the_table_is_not_for_is_refused(self):
        other = self.folder / "other.csv"
        self.run_well("plan", "circle", "--model", KR270, "--center", "1.6,0.1,1.2", "--plane", "xz",
                      "--points", "60", "--out", other)
        told = self.verify(self.true, "--path", other)
        self.assertEqual(2, told.returncode)
        self.assertRegex(told.stderr, r"other\.csv:2: lies \S+ rad outside the table")

    def test_json_tells_what_was_derived_and_what_was_checked(self):
        told = json.loads(self.run_well("table", "verify", self.true, "--model", KR270, "--json", "--samples", "200"))
        self.assertTrue(told["holds"])
        self.assertTrue(told["gain_checked"])
        self.assertTrue(told["inside_checked"])
        self.assertFalse(told["program_checked"])
        self.assertEqual(0.002, round(told["gain_basis"]["depth_of_cut"], 9))
        self.assertLessEqual(told["derived_inside_position_error"], told["certified_inside_position_error"])
        self.assertLessEqual(told["derived_position_error"], told["certified_position_error"])


if __name__ == "__main__":
    unittest.main()
