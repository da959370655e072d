"""flexcomp convert against the logs that can-utils and LCM write and read themselves."""

import csv
import re
import subprocess
import time
import unittest
from statistics import median

import can

from bench_on_a_bus import BUS, LCM, HilTest, Job, candump, flexcomp, lcm_logger

STEPS = {"q": 1.1e-7, "f": 0.051, "m": 0.0051, "x": 1.1e-7, "y": 1.1e-7, "z": 1.1e-7}  # half a raw step


def rows(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def frames(log):
    """Identifiers and data in a candump log, without the flags of FD frames."""
    return [re.sub("##.", "##", line.split()[2]) for line in log.read_text().splitlines()]


class Logs(HilTest):
    def setUp(self):
        super().setUp()
        job = Job(self.folder)
        path = self.folder / "run.csv"
        flexcomp("plant", "--model", job.model, "--path", job.path, "--table", job.table, "--out", path)
        lines = path.read_text().splitlines()
        self.csv = self.folder / "short.csv"
        self.csv.write_text("\n".join(lines[:301]) + "\n")

    def assert_same(self, expected, actual, time_step, of_late=max):
        """`of_late`: of how late the rows are, the one that counts."""
        expected, actual = rows(expected), rows(actual)
        self.assertEqual(len(expected), len(actual))
        for wanted, found in zip(expected, actual):
            self.assertEqual(set(wanted), set(found))
            for name, value in wanted.items():
                if name != "t":
                    self.assertAlmostEqual(float(value), float(found[name]), delta=STEPS[name[0]], msg=name)
        late = [abs(float(wanted["t"]) - float(found["t"])) for wanted, found in zip(expected, actual)]
        self.assertLessEqual(of_late(late), time_step)

    def assert_comes_back(self, play, log, time_step):
        """Plays again, twice at most, where a busy machine lost or delayed many. A player plays some rows late
        on any."""
        back = self.folder / "back.csv"
        for _ in range(3):
            play()
            flexcomp("convert", log, "--out", back)
            times = [[float(row["t"]) for row in rows(path)] for path in (self.csv, back)]
            if len(times[0]) == len(times[1]) and median(abs(a - b) for a, b in zip(*times)) <= time_step:
                break
        self.assert_same(self.csv, back, time_step, median)

    def test_what_canplayer_plays_from_our_log_comes_back_from_candump(self):
        for fd in ((), ("--fd",)):
            with self.subTest(fd=fd):
                ours, theirs = self.folder / "ours.log", self.folder / "theirs.log"
                flexcomp("convert", self.csv, "--out", ours, "--start", 1e9, *fd)

                def play():
                    with candump(theirs):
                        subprocess.run(["canplayer", "-I", ours, f"{BUS}=can0"], check=True)
                    self.assertEqual(frames(ours), frames(theirs))

                self.assert_comes_back(play, theirs, 0.05)

    def test_log2asc_reads_our_log_as_we_meant_it(self):
        ours, asc = self.folder / "ours.log", self.folder / "ours.asc"
        flexcomp("convert", self.csv, "--out", ours, "--start", 1e9)
        subprocess.run(["log2asc", "-I", ours, "-O", asc, "can0"], check=True, stdout=subprocess.DEVNULL)
        frames = [(m.arbitration_id, bytes(m.data), m.timestamp) for m in can.ASCReader(str(asc))]
        lines = [line.split() for line in ours.read_text().splitlines()]
        self.assertEqual(len(lines), len(frames))
        start = float(lines[0][0].strip("()"))
        for (stamp, _, text), (identifier, data, at) in zip(lines, frames):
            self.assertEqual(text, f"{identifier:03X}#{data.hex().upper()}")
            self.assertAlmostEqual(float(stamp.strip("()")) - start, at - frames[0][2], delta=2e-6)

    def test_what_lcm_logplayer_plays_from_our_log_comes_back_from_lcm_logger(self):
        ours, theirs = self.folder / "ours.lcmlog", self.folder / "theirs.lcmlog"
        flexcomp("convert", self.csv, "--out", ours, "--start", 1e9)

        def play():
            with lcm_logger(theirs):
                time.sleep(0.3)
                subprocess.run(["lcm-logplayer", f"--lcm-url={LCM}", str(ours)], check=True,
                               stdout=subprocess.DEVNULL)
                time.sleep(0.3)

        self.assert_comes_back(play, theirs, 0.05)

    def test_can_and_lcm_logs_of_one_run_are_put_into_one_time(self):
        """The force only on LCM, the rest on CAN, and the clocks 7 s apart."""
        setpoints, all_of_it, back = (self.folder / n for n in ("can.log", "lcm.lcmlog", "back.csv"))
        source = rows(self.csv)
        without = self.folder / "without.csv"
        with open(without, "w", newline="") as file:
            names = [name for name in source[0] if name[0] not in "fm"]
            writer = csv.DictWriter(file, names, extrasaction="ignore")
            writer.writeheader()
            writer.writerows(source)
        flexcomp("convert", without, "--out", setpoints, "--start", 1e9)
        flexcomp("convert", self.csv, "--out", all_of_it, "--start", 1e9 + 7)
        said = flexcomp("convert", setpoints, all_of_it, "--out", back)
        self.assertIn("-7.0000", said)
        merged = rows(back)
        self.assertEqual(len(source), len(merged))
        with_force = [row for row in merged if row["fx"]]
        self.assertGreaterEqual(len(with_force), len(source) - 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
