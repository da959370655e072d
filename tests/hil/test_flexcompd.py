"""flexcompd as a process: what a test engineer can do to it from outside."""

import contextlib
import os
import pathlib
import signal
import subprocess
import tempfile
import time
import unittest

import can

from bench_on_a_bus import (BIN, BUS, STATES, Feeder, Flexcompd, HilTest, Job, candump, corrections, decode,
                            decoded, flexcomp, other_table, state_of, states, table_frames, transfer)

HERE = pathlib.Path(__file__).parent


def shared_library(folder, name):
    library = folder / f"{name}.so"
    subprocess.run([os.environ["FLEXCOMP_C"], "-shared", "-fPIC", "-O1", "-o", library, HERE / f"{name}.c",
                    "-ldl"], check=True)
    return library


class Process(HilTest):
    """Periods of 10 ms: a client in Python, in a guest on a busy machine, has to keep up."""

    def setUp(self):
        super().setUp()
        self.job = Job(self.folder, period=0.01)
        self.job.be_patient()
        self.peer = self.client()
        self.feeder = Feeder(self.job, self.peer)

    def bring_up(self):
        """Makes it active; next to nothing is decoded on the way, so that the setpoints go on."""
        for _ in range(3):
            self.feeder.forget()
            self.feeder.run(0.4)
            self.peer.command("arm")
            received = self.feeder.run(1.0)
            if state_of(received) == STATES["active"]:
                break
        return received


class Bus(Process):
    def test_a_client_made_from_the_dbc_alone_understands_every_frame(self):
        log = self.folder / "all.log"
        with candump(log), Flexcompd(self.job) as node:
            self.bring_up()
            self.peer.command("report")
            self.feeder.run(0.5)
            node.stop()
        seen = set()
        counters = {}
        for frame in can.CanutilsLogReader(str(log)):
            name, signals = decode(frame)
            seen.add(name)
            last = counters.get(name)
            self.assertTrue(last is None or signals["counter"] == (last + 1) % 16, name)
            counters[name] = signals["counter"]
        expected = {"CorrectedA", "UncorrectedC", "Status", "Latched", "Heartbeat", "TableLow", "TableHigh",
                    "Statistic", "CommandReply", "Fault", "SetpointA", "WrenchForce", "IdentityHigh"}
        self.assertEqual(set(), expected - seen)

    def test_it_answers_fd_with_fd(self):
        with Flexcompd(self.job, "--fd") as node:
            self.assertEqual(0, self.feeder.arm())
            answers = [signals for name, signals in decoded(self.feeder.run(0.8)) if name == "CorrectedFd"]
            self.assertEqual(STATES["active"], answers[-1]["state"])
            self.assertNotEqual(answers[-1]["q2"], answers[-1]["uncorrected2"])
            node.stop()

    def test_a_full_queue_makes_it_fade_out_and_it_recovers(self):
        flag = self.folder / "full"
        library = shared_library(self.folder, "full_queue")
        with Flexcompd(self.job, preload=library, environment={"FLEXCOMP_FULL_QUEUE": str(flag)}) as node:
            self.bring_up()
            flag.touch()
            self.feeder.forget()
            self.assertEqual([], corrections(self.feeder.run(0.5)))
            flag.unlink()
            received = self.feeder.run(1.5)
            self.assertEqual(STATES["latched"], states(received)[-1])
            self.assert_zero(received)
            self.peer.command("reset")
            self.assertEqual(0, self.feeder.arm())
            node.stop()
            self.assertGreater(node.statistics()["dropped_frames"], 0)

    def test_bus_off_makes_it_fade_out(self):
        with Flexcompd(self.job) as node:
            self.bring_up()
            self.peer.bus.send(can.Message(arbitration_id=0x40, is_error_frame=True, is_extended_id=False,
                                           data=bytes(8)))
            received = self.feeder.run(1.5)
            self.assertEqual(STATES["latched"], states(received)[-1])
            self.assertTrue(any(signals["node_status"] & 1 << 6 for name, signals in decoded(received)
                                if name == "Status"))
            node.stop()

    def test_an_interface_that_goes_down_and_up_is_survived(self):
        with Flexcompd(self.job) as node:
            self.bring_up()
            subprocess.run(["ip", "link", "set", BUS, "down"], check=True)
            time.sleep(0.4)
            subprocess.run(["ip", "link", "set", BUS, "up"], check=True)
            with contextlib.suppress(can.CanError):  # the socket says once that it was down
                self.peer.send_identity(self.job.model_hash)
            received = self.feeder.run(1.5)
            self.assertEqual(STATES["latched"], states(received)[-1])
            self.peer.command("reset")
            self.assertEqual(0, self.feeder.arm())
            self.assertEqual(0, node.stop())

    def test_two_of_them_on_one_bus_latch(self):
        with Flexcompd(self.job) as node:
            self.bring_up()
            with Flexcompd(self.job, wait=False) as other:
                received = self.feeder.run(0.1)
                while not other.ticks():
                    received += self.feeder.run(0.1)
                received += self.feeder.run(1.5)
                self.assertIn(STATES["latched"], states(received))
                self.assertTrue(any(name == "Fault" and signals["code"] == 0x7107
                                    for name, signals in decoded(received)))
                other.stop()
            node.stop()


class Life(Process):
    def test_at_sigterm_it_fades_to_zero_within_the_limits_and_ends(self):
        with Flexcompd(self.job) as node:
            self.bring_up()
            node.process.send_signal(signal.SIGTERM)
            received = self.feeder.run(1.5)
            self.assertEqual(0, node.process.wait(timeout=5))
            self.assert_limits(received, self.job.period)
            self.assert_zero(received)
            self.assertIn("ticks", node.messages())

    def test_killed_in_the_cut_it_starts_at_zero_and_waits_to_be_armed(self):
        with Flexcompd(self.job) as node:
            self.bring_up()
            node.process.kill()
        with Flexcompd(self.job) as node:
            self.feeder.forget()
            received = self.feeder.run(1.0)
            self.assertEqual({STATES["off"]}, set(states(received)))
            self.assertEqual({0.0}, {round(value, 9) for row in corrections(received) for value in row})
            self.assertEqual(0, self.feeder.arm())
            node.stop()

    def test_started_as_root_it_becomes_the_user_and_corrects_as_before(self):
        if pathlib.Path("/proc/self/uid_map").read_text().split()[2] == "1":
            self.skipTest("there is but one user in this namespace")
        with Flexcompd(self.job, "--user", "nobody") as node:
            for task in pathlib.Path(f"/proc/{node.process.pid}/task").iterdir():
                status = dict(line.split(":\t") for line in (task / "status").read_text().splitlines())
                self.assertNotIn("0", status["Uid"].split() + status["Gid"].split() + status["Groups"].split())
                self.assertEqual(0, int(status["CapPrm"], 16) | int(status["CapEff"], 16))
                self.assertEqual("1", status["NoNewPrivs"].strip())
                if status["Name"].strip() == "flexcomp-rt" and "no SCHED_FIFO" not in node.messages():
                    self.assertEqual(os.SCHED_FIFO, os.sched_getscheduler(int(task.name)))
            self.assertEqual(0, self.feeder.arm())
            self.assertEqual(STATES["active"], states(self.feeder.run(0.5))[-1])
            self.assertEqual(0, node.stop(), node.messages())

    def test_stopped_for_a_while_it_counts_the_late_ticks_and_never_jumps(self):
        with Flexcompd(self.job) as node:
            received = self.bring_up()
            node.process.send_signal(signal.SIGSTOP)
            self.feeder.run(0.1)
            node.process.send_signal(signal.SIGCONT)
            received += self.feeder.run(1.0)
            self.assert_limits(received, self.job.period)
            node.stop()
            self.assertGreater(node.statistics()["late_ticks"], 0)

    def test_statistics_are_written_when_asked_for(self):
        with Flexcompd(self.job) as node:
            self.bring_up()
            node.process.send_signal(signal.SIGUSR1)
            self.feeder.run(0.3)
            statistics = node.statistics()
            self.assertGreater(statistics["setpoint"]["received"], 100)
            self.assertGreater(sum(statistics["latency_log2_us"]), 100)
            node.stop()

    def test_a_new_configuration_is_refused_while_correcting_and_taken_when_off(self):
        with Flexcompd(self.job) as node:
            self.bring_up()
            self.job.config.write_text(self.job.config.read_text().replace("gain = 1\n", "gain = 0.5\n"))
            node.process.send_signal(signal.SIGHUP)
            received = self.feeder.run(0.5)
            self.assertEqual(STATES["active"], states(received)[-1])
            self.assertIn("new configuration: not ready", node.messages())
            whole = corrections(received)[-1]
            self.peer.command("disarm")
            self.feeder.run(1.0)
            node.process.send_signal(signal.SIGHUP)
            self.feeder.run(0.5)
            self.assertIn("new configuration: ok", node.messages())
            self.assertEqual(0, self.feeder.arm())
            # The same place of the circle, half the correction.
            self.feeder.place = 0
            self.feeder.run(0.5)
            half = corrections(self.feeder.run(0.2))[-1]
            self.assertLess(max(map(abs, half)), 0.75 * max(map(abs, whole)))
            node.stop()

    def test_the_real_time_thread_never_touches_the_heap(self):
        library = shared_library(self.folder, "abort_on_allocation")
        with Flexcompd(self.job, preload=library) as node:
            self.bring_up()
            self.peer.command("report")
            self.feeder.run(1.0)
            self.assertEqual(0, node.stop(), node.messages())
        control = subprocess.run([str(BIN / "flexcompd"), "--version"], capture_output=True,
                                 env=dict(os.environ, LD_PRELOAD=str(library), FLEXCOMP_ABORT_ANYWHERE="1"))
        self.assertEqual(99, control.returncode, "the trap does not work")


class Tables(Process):
    def memory(self):
        """A folder that no disk is behind, for which a whole guest would stand still; disks that stall are
        test_service.py's business."""
        scratch = tempfile.TemporaryDirectory(dir="/dev/shm")
        self.addCleanup(scratch.cleanup)
        return pathlib.Path(scratch.name)

    def test_a_table_over_the_bus_is_swapped_in_while_correcting_and_kept(self):
        state = self.memory()
        with Flexcompd(self.job, "--state-directory", state) as node:
            frames = table_frames(self.peer, other_table(self.job))
            self.bring_up()
            received, replies = transfer(self.feeder, frames)
            self.assertEqual([0, 0], [reply["result"] for reply in replies])
            self.assert_limits(received, self.job.period)
            # A busy machine may stop a whole guest for a moment: held, but no more.
            self.assertLessEqual(set(states(received)), {STATES["active"], STATES["holding"]})
            self.assertEqual(STATES["active"], states(received)[-1])
            beats = [signals["slot"] for name, signals in decoded(received) if name == "Heartbeat"]
            self.assertEqual(2, beats[-1])
            self.assertEqual(0, node.stop())
        self.assertIn(other_table(self.job), [file.read_bytes() for file in state.iterdir()])
        self.job.table.unlink()
        with Flexcompd(self.job, "--state-directory", state) as node:
            self.assertEqual(0, self.feeder.arm())
            node.stop()

    def test_a_damaged_table_is_refused_and_the_one_in_use_stays(self):
        with Flexcompd(self.job) as node:
            data = bytearray(other_table(self.job))
            data[500] ^= 1
            frames = table_frames(self.peer, bytes(data))
            self.bring_up()
            received, replies = transfer(self.feeder, frames)
            self.assertEqual(12, replies[-1]["result"])
            self.assertEqual({STATES["active"]}, set(states(received)))
            node.stop()

    def test_killed_during_a_transfer_it_starts_with_the_old_table(self):
        state = self.folder / "state"
        state.mkdir()
        with Flexcompd(self.job, "--state-directory", state) as node:
            self.feeder.run(1.5, table_frames(self.peer, other_table(self.job), words=200))
            node.process.kill()
        with Flexcompd(self.job, "--state-directory", state) as node:
            self.assertEqual(0, self.feeder.arm())
            node.stop()

    def test_with_the_newer_of_two_kept_tables_damaged_it_starts_with_the_older(self):
        state = self.folder / "state"
        state.mkdir()
        (state / "table-a.fct").write_bytes(self.job.table.read_bytes())
        (state / "table-b.fct").write_bytes(other_table(self.job)[:-8])
        (state / "active").write_text("table-b.fct")
        self.job.table.unlink()
        with Flexcompd(self.job, "--state-directory", state) as node:
            self.assertEqual(0, self.feeder.arm())
            node.stop()


class NodeCommand(Process):
    def test_it_arms_sends_a_table_and_disarms(self):
        with Flexcompd(self.job) as node, subprocess.Popen(
                [str(BIN / "flexcomp"), "plant", "--model", self.job.model, "--path", self.job.path,
                 "--period", "0.01", "--bus", f"can:{BUS}", "--without-compensation"],
                stdout=subprocess.DEVNULL) as plant:
            bus = ("--bus", f"can:{BUS}")
            self.peer.wait_for("SetpointA")
            time.sleep(0.5)
            self.assertEqual("ok\n", flexcomp("node", "arm", *bus))
            self.assertIn("not ready", flexcomp("node", "arm", *bus, code=1))
            self.assertEqual("ok\n", flexcomp("node", "send-table", self.job.table, *bus))
            self.assertEqual("ok\n", flexcomp("node", "disarm", *bus))
            self.assertEqual("ok\n", flexcomp("node", "reset", *bus))
            plant.terminate()
            node.stop()
        done = subprocess.run([str(BIN / "flexcomp"), "node", "arm", *bus], capture_output=True, text=True)
        self.assertEqual(2, done.returncode)
        self.assertIn("nobody answers", done.stderr)


class Arguments(HilTest):
    def refuse(self, *arguments, saying):
        done = subprocess.run([str(BIN / "flexcompd"), *map(str, arguments)], capture_output=True, text=True,
                              timeout=10)
        self.assertEqual(2, done.returncode, done.stderr)
        self.assertEqual(1, done.stderr.count("\n"), done.stderr)
        self.assertIn(saying, done.stderr)

    def test_bad_arguments_get_one_line(self):
        good = ("--model-hash", "0092596dd2483751")
        text = self.folder / "text.fct"
        text.write_text("no table, but long enough to be read as one" * 10)
        config = self.folder / "bad.toml"
        config.write_text("no-such-option = 1\n")
        self.refuse(saying="--model-hash")
        self.refuse(*good, saying="--can, --lcm or --rsi")
        self.refuse("--model-hash", "xyz", "--can", BUS, saying="16 hexadecimal digits")
        self.refuse(*good, "--can", "nocan7", saying="nocan7")
        self.refuse(*good, "--can", "lo", "--fd", saying="lo")
        self.refuse(*good, "--can", BUS, "--period", "-1", saying="--period")
        self.refuse(*good, "--can", BUS, "--joint-speed", "1,2,3", saying="--joint-speed")
        self.refuse(*good, "--can", BUS, "--gain", "0", saying="--gain: a number of the configuration")
        self.refuse(*good, "--can", BUS, "--table", "/no/such.fct", saying="/no/such.fct")
        self.refuse(*good, "--can", BUS, "--table", text, saying="not a flexcomp table")
        self.refuse(*good, "--can", BUS, "--table", "/dev/null", saying="/dev/null")
        self.refuse("--config", config, "--can", BUS, saying="no-such-option")
        self.refuse("--config", "/no/such.toml", "--can", BUS, saying="/no/such.toml")


if __name__ == "__main__":
    unittest.main(verbosity=2)
