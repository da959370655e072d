"""flexcompd where disks stall, files are no files and memory runs out: it goes on, or fades and ends."""

import os
import signal
import time
import unittest

import can

from bench_on_a_bus import (BUS, LCM, STATES, Flexcompd, decoded, other_table, states, table_frames)
from test_flexcompd import Process, shared_library


class Ending(Process):
    def assert_ends(self, node, code=0):
        """By SIGTERM, within five seconds."""
        node.process.send_signal(signal.SIGTERM)
        self.assertEqual(code, node.process.wait(timeout=5), node.messages())

    def test_it_ends_when_the_configuration_has_become_a_fifo(self):
        with Flexcompd(self.job) as node:
            self.job.config.unlink()
            os.mkfifo(self.job.config)
            node.process.send_signal(signal.SIGHUP)
            time.sleep(0.5)
            self.assertIn("not an ordinary file", node.messages())
            self.assert_ends(node)

    def test_it_ends_when_the_configuration_has_become_huge(self):
        with Flexcompd(self.job) as node:
            self.job.config.write_text("gain = 0.5\n" * 200000)
            node.process.send_signal(signal.SIGHUP)
            time.sleep(0.5)
            self.assertIn("larger than", node.messages())
            self.assert_ends(node)

    def test_it_ends_when_a_fifo_stands_where_statistics_are_written(self):
        with Flexcompd(self.job) as node:
            os.mkfifo(f"{node.statistics_file}.new")
            node.process.send_signal(signal.SIGUSR1)
            time.sleep(0.5)
            self.assertIn("not an ordinary file", node.messages())
            self.assert_ends(node)

    def test_it_ends_when_nobody_reads_what_it_says(self):
        reader, writer = os.pipe()
        with Flexcompd(self.job, stderr=writer) as node:
            os.set_blocking(writer, False)
            try:
                while os.write(writer, bytes(4096)):
                    pass
            except BlockingIOError:
                pass
            os.set_blocking(writer, True)
            node.process.send_signal(signal.SIGUSR1)
            time.sleep(0.3)
            self.assert_ends(node)
        os.close(reader)
        os.close(writer)

    def test_where_its_service_has_no_memory_it_fades_to_zero_and_ends_as_after_a_fault_of_its_own(self):
        flag = self.folder / "no_memory"
        library = shared_library(self.folder, "no_memory")
        with Flexcompd(self.job, preload=library, environment={"FLEXCOMP_NO_MEMORY": str(flag)}) as node:
            self.bring_up()
            flag.touch()
            node.process.send_signal(signal.SIGHUP)
            received = self.feeder.run(1.5)
            self.assertEqual(3, node.process.wait(timeout=5), node.messages())
            self.assert_limits(received, self.job.period)
            self.assert_zero(received)
            self.assertIn("internal fault", node.messages())


class SlowDisk(Process):
    def test_tables_are_taken_and_nothing_latches_while_the_disk_stalls(self):
        state = self.folder / "state"
        state.mkdir()
        library = shared_library(self.folder, "slow_disk")
        tables = [other_table(self.job), self.job.table.read_bytes(), other_table(self.job)]
        # One after the other with a pause, which frames that nobody knows fill: a client that stops to
        # look at what it received would let the setpoints become stale.
        pause = [can.Message(arbitration_id=0x7FF, is_extended_id=False)] * 500
        frames = [frame for table in tables for frame in table_frames(self.peer, table) + pause]
        with Flexcompd(self.job, "--state-directory", state, preload=library,
                       bus=("--can", BUS, "--lcm", LCM)) as node:
            self.bring_up()
            received = self.feeder.run(1.0, frames)
            messages = decoded(received)
            self.assertEqual([(stage, 0) for _ in tables for stage in (1, 3)],
                             [(signals["stage"], signals["result"]) for name, signals in messages
                              if name == "TransferReply"])
            self.assertFalse([signals for name, signals in messages
                              if name == "Fault" and signals["code"] == 0x7107], "took its echo for another")
            self.assertLessEqual(set(states(received)), {STATES["active"], STATES["holding"]},
                                 [signals for name, signals in messages if name == "Fault"])
            node.process.send_signal(signal.SIGTERM)
            self.assertEqual(0, node.process.wait(timeout=5), node.messages())


if __name__ == "__main__":
    unittest.main(verbosity=2)
