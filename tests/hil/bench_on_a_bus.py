"""Shared parts of the hardware-in-loop tests: the real programs, and a client of the bus that knows
nothing of flexcomp but flexcomp.dbc."""

import json
import math
import os
import pathlib
import signal
import socket
import subprocess
import tempfile
import time
import unittest
import zlib

import can
import cantools
import crccheck.crc

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
BIN = pathlib.Path(os.environ["FLEXCOMP_BIN"])
ROBOTS = SOURCE / "host" / "robots"
DBC = SOURCE / "firmware" / "messages" / "flexcomp.dbc"
BUS = os.environ.get("FLEXCOMP_BUS", "vcan0")
ROOM_WITHIN = 5  # s, in the queue of the interface
LCM = "udpm://239.255.76.67:7667?ttl=0"
NOT_READY = 15  # a reply
STATES = {"off": 0, "fading_in": 1, "active": 2, "holding": 3, "fading_out": 4, "latched": 5}


def flexcomp(*arguments, code=0):
    done = subprocess.run([str(BIN / "flexcomp"), *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != code:
        raise AssertionError(f"{arguments}: exit {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout


def circularity(recording):
    """By least squares in the plane of the circle, m."""
    return json.loads(flexcomp("circularity", recording, "--columns", "x,z", "--json"))["lsc"]["circularity"]


class Job:
    """A robot with its circle, table and configuration in a folder."""

    def __init__(self, folder, robot="kr270", feed=0.1, *table_options, period=0.004, radius=0.1, model=None):
        self.period = period
        self.model = model or ROBOTS / robot / "robot.yaml"
        self.folder = pathlib.Path(folder)
        self.path = self.folder / f"{robot}.csv"
        self.table = self.folder / f"{robot}.fct"
        self.config = self.folder / f"{robot}.toml"
        flexcomp("plan", "circle", "--model", self.model, "--center", "1.6,0,1.2", "--plane", "xz",
                 "--radius", radius, "--points", 720, "--feed", feed, "--out", self.path)
        flexcomp("table", "--model", self.model, "--path", self.path, "--tolerance", 1e-6,
                 "--out", self.table, *table_options)
        flexcomp("configure", "--model", self.model, "--table", self.table, "--period", period,
                 "--out", self.config)
        self.model_hash = json.loads(
            flexcomp("table", "verify", self.table, "--model", self.model, "--samples", 1, "--json")
        )["model_hash"]

    def be_patient(self, seconds=0.5):
        """For a client in Python, in a guest on a busy machine: so long without a setpoint is no
        fault. How staleness is answered is the fault catalogue's business."""
        with open(self.config, "a") as config:
            config.write(f"setpoint-age-limit = {seconds}\nwrench-age-limit = {seconds}\nlate-ticks = 100\n")


class Flexcompd:
    """The real process, ended by SIGTERM."""

    def __init__(self, job, *options, preload=None, bus=("--can", BUS), environment=None,
                 wait=True, stderr=None):
        self.statistics_file = job.folder / "statistics.json"
        self.log = open(job.folder / "flexcompd.log", "w+")
        env = dict(os.environ, **(environment or {}))
        if preload:
            env["LD_PRELOAD"] = str(preload)
        self.process = subprocess.Popen(
            [str(BIN / "flexcompd"), "--config", str(job.config), "--statistics",
             str(self.statistics_file), *bus, *map(str, options)], stderr=stderr or self.log, env=env)
        latest = time.monotonic() + 10
        while wait and not self.ticks() and time.monotonic() < latest:
            time.sleep(0.02)
        time.sleep(0.3)  # for the rest of its start, such as becoming another user
        if self.process.poll() is not None:
            raise AssertionError(f"flexcompd ended: {self.messages()}")

    def ticks(self):
        """Has its real-time thread begun? A guest Linux may take seconds to start a process."""
        try:
            tasks = pathlib.Path(f"/proc/{self.process.pid}/task").glob("*/comm")
            began = any(task.read_text() == "flexcomp-rt\n" for task in tasks)
        except FileNotFoundError:  # it ended in between
            began = False
        return began or self.process.poll() is not None

    def messages(self):
        self.log.flush()
        return pathlib.Path(self.log.name).read_text()

    def stop(self):
        """Ends it; its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=10)

    def statistics(self):
        return json.loads(self.statistics_file.read_text())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.log.close()


class Listener:
    """A process that listens until it is stopped, such as candump."""

    def __init__(self, command, output):
        self.output = open(output, "w")
        self.process = subprocess.Popen(command, stdout=self.output)
        latest = time.monotonic() + 10
        while not self._has_a_socket() and time.monotonic() < latest:
            time.sleep(0.02)
        time.sleep(0.2)  # for what it does to the socket before it listens

    def _has_a_socket(self):
        descriptors = pathlib.Path(f"/proc/{self.process.pid}/fd").iterdir()
        return any(os.readlink(descriptor).startswith("socket:") for descriptor in descriptors)

    def __enter__(self):
        return self

    def _rest(self):
        """While it waits: how often it has begun to."""
        status = dict(line.split(":\t") for line in
                      pathlib.Path(f"/proc/{self.process.pid}/status").read_text().splitlines())
        return status["voluntary_ctxt_switches"] if status["State"].startswith("S") else None

    def __exit__(self, *_):
        latest = time.monotonic() + 10
        rests = [None]
        # Until it has read what waited to be read, and nothing comes.
        while (None in rests[-4:] or len(set(rests[-4:])) > 1) and time.monotonic() < latest:
            time.sleep(0.1)
            rests.append(self._rest())
        self.process.send_signal(signal.SIGINT)
        self.process.wait()
        self.output.close()


ROOM = 32 << 20  # bytes that a logger on a busy processor need not have read yet


def candump(output):
    return Listener(["candump", "-r", str(ROOM), "-L", BUS], output)


def lcm_logger(log):
    """It goes first on a processor that all share. It may miss messages all the same: LCM goes by UDP."""
    url = f"{LCM}&recv_buf_size={ROOM}"
    return Listener(["nice", "-n", "-15", "lcm-logger", "--quiet", "--force", "--lcm-url", url, str(log)],
                    "/dev/null")


DATABASE = cantools.database.load_file(str(DBC))


def checksum(message, payload):
    protected = message.dbc.attributes["E2EDataId"].value.to_bytes(2, "little")
    if message.is_fd:
        return crccheck.crc.Crc16Ibm3740.calc(protected + bytes(payload[2:]))
    return crccheck.crc.Crc8Autosar.calc(protected + bytes(payload[1:]))


def decode(frame):
    """Name and signals; raises where the DBC does not fit."""
    message = DATABASE.get_message_by_frame_id(frame.arbitration_id)
    signals = message.decode(frame.data, decode_choices=False)
    if signals["crc"] != checksum(message, frame.data):
        raise AssertionError(f"{message.name}: checksum")
    return message.name, signals


def decoded(frames):
    return [decode(frame) for frame in frames if not frame.is_error_frame]


class Client:
    """A client of the bus made from the DBC alone: python-can moves the frames, cantools packs and
    unpacks them, crccheck protects them."""

    def __init__(self):
        self.bus = can.Bus(interface="socketcan", channel=BUS, fd=True)
        # Room for all that comes while this client is busy. (SO_RCVBUFFORCE has no name in Python.)
        self.bus.socket.setsockopt(socket.SOL_SOCKET, 33, 1 << 24)
        self.counters = {}

    def close(self):
        self.bus.shutdown()

    def wait_for(self, name, seconds=10):
        """Until somebody sends such a message."""
        latest = time.monotonic() + seconds
        identifier = DATABASE.get_message_by_name(name).frame_id
        while (left := latest - time.monotonic()) > 0:
            frame = self.bus.recv(left)
            if frame is not None and frame.arbitration_id == identifier:
                return
        raise AssertionError(f"no {name} within {seconds} s")

    def receive(self, seconds):
        """All frames of a time."""
        received = []
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            frame = self.bus.recv(left)
            if frame is not None:
                received.append(frame)
        return received

    def encode(self, name, counter, **signals):
        message = DATABASE.get_message_by_name(name)
        values = {signal.name: 0 for signal in message.signals} | signals | {"counter": counter, "crc": 0}
        payload = message.encode(values, strict=False)
        payload = message.encode(values | {"crc": checksum(message, payload)}, strict=False)
        return can.Message(arbitration_id=message.frame_id, data=payload, is_extended_id=False,
                           is_fd=message.is_fd, bitrate_switch=message.is_fd)

    def frames(self, *names, **signals):
        """One message of one or several frames, of one counter."""
        counter = self.counters.get(names[0], 0)
        fd = DATABASE.get_message_by_name(names[0]).is_fd
        self.counters[names[0]] = (counter + 1) % (256 if fd else 16)
        result = []
        for name in names:
            own = {signal.name for signal in DATABASE.get_message_by_name(name).signals}
            result.append(self.encode(name, counter, **{k: v for k, v in signals.items() if k in own}))
        return result

    def put(self, frame):
        """Sends a frame once the interface has room for it: on a busy machine, and where a serial line
        carries the frames, its queue empties late."""
        self.bus.send(frame, timeout=ROOM_WITHIN)

    def send(self, *names, **signals):
        for frame in self.frames(*names, **signals):
            self.put(frame)

    def send_setpoint(self, q):
        self.send("SetpointA", "SetpointB", "SetpointC", **{f"q{i + 1}": q[i] for i in range(6)})

    def send_wrench(self, wrench, saturated=0):
        self.send("WrenchForce", "WrenchMoment", saturated=saturated,
                  **dict(zip(("fx", "fy", "fz", "mx", "my", "mz"), wrench)))

    def send_identity(self, model_hash, frame=1):
        value = int(model_hash, 16)
        self.send("IdentityLow", "IdentityHigh", model_hash_low=value & 0xFFFFFFFF,
                  model_hash_high=value >> 32, wrench_frame=frame)

    def command(self, name):
        self.send("Command", command={"arm": 1, "disarm": 2, "reset": 3, "report": 4}[name])


class Feeder:
    """Plays the robot controller and the force sensor in real time, along the circle and back."""

    def __init__(self, job, client):
        rows = [line.split(",") for line in job.path.read_text().splitlines()]
        column = {name: i for i, name in enumerate(rows[0])}
        self.q = [[float(row[column[f"q_cmd_{i}"]]) for i in range(1, 7)] for row in rows[1:]]
        self.wrench = [[float(row[column[name]]) for name in ("fx", "fy", "fz", "mx", "my", "mz")]
                       for row in rows[1:]]
        self.client = client
        self.job = job
        self.place = 0

    def run(self, seconds, extra=()):
        """Feeds for a time, and until all of `extra` is sent, ten frames a tick; the frames that
        were received meanwhile. Whoever stops feeding, to decode them say, makes the setpoints stale."""
        received = []
        extra = list(extra)
        next_tick = time.monotonic()
        for _ in range(max(int(seconds / self.job.period), len(extra) // 10 + 1)):
            self.place += 1
            for frame in extra[:10]:
                self.client.put(frame)
            del extra[:10]
            row = self.place // 4 % len(self.q)
            after = (row + 1) % len(self.q)
            share = self.place % 4 / 4
            q = [a + share * (b - a) for a, b in zip(self.q[row], self.q[after])]
            if self.place % 50 == 1:
                self.client.send_identity(self.job.model_hash)
            noise = 2 * math.sin(self.place)
            self.client.send_wrench([w + noise for w in self.wrench[row][:3]] + self.wrench[row][3:])
            self.client.send_setpoint(q)
            # Whoever fell behind on a busy machine goes on from there: a burst would fill a slow line.
            next_tick = max(next_tick + self.job.period, time.monotonic())
            received += self.client.receive(next_tick - time.monotonic())
        while (frame := self.client.bus.recv(0)) is not None:
            received.append(frame)
        return received

    def run_until(self, done, before=(), longest=5):
        """Feeds until `done` holds of the frames received `before` and since, for the longest time (s) at most;
        those since."""
        received = []
        end = time.monotonic() + longest
        while not received or not done([*before, *received]) and time.monotonic() < end:
            received += self.run(0.5)
        return received

    def forget(self):
        """Drops what was received and not yet looked at."""
        while self.client.bus.recv(0) is not None:
            pass

    def arm(self):
        """Answer to arming. A node that has missed a setpoint is not ready, and is asked again."""
        for _ in range(3):
            self.run(0.4)
            self.client.command("arm")
            replies = [signals for name, signals in decoded(self.run(1.0)) if name == "CommandReply"]
            if replies[0]["reply"] != NOT_READY:
                break
        return replies[0]["reply"]


def table_frames(client, data, words=None):
    """A whole transfer of a table, or its begin and the first words."""
    crc = zlib.crc32(data)
    count = words if words is not None else len(data) // 4
    frames = client.frames("TransferBegin", size=len(data), table_crc=crc)
    for i in range(count):
        word = int.from_bytes(data[4 * i:4 * i + 4], "little")
        frames += client.frames("TransferData", word_index=i, word=word)
    return frames + (client.frames("TransferEnd", table_crc=crc) if words is None else [])


def of_names(received, *names):
    """Those messages alone. Decoding all of them would take so long that setpoints became stale."""
    identifiers = {DATABASE.get_message_by_name(name).frame_id for name in names}
    return decoded(frame for frame in received if frame.arbitration_id in identifiers)


TRANSFERRED_WITHIN = 20  # s after the last frame was handed over: beside other tests 5 s were too few
TRANSFERS = 3


def transfer(feeder, frames):
    """Sends them between setpoints; what was received, and the replies to begin and end in it. Goes on until
    the node has said after them which table it uses: a slow line is still busy with the frames when the
    last one was handed to it. A node whose line is full drops a reply; who misses it sends all again."""
    def has_told(received):
        told = of_names(received, "TransferReply", "Heartbeat")
        return len(replies_in(told)) >= 2 and told[-1][0] == "Heartbeat"

    received = []
    for _ in range(TRANSFERS):
        since = feeder.run(1.0, frames)
        since += feeder.run_until(has_told, since, TRANSFERRED_WITHIN)
        received += since
        replies = replies_in(of_names(since, "TransferReply"))
        if len(replies) >= 2:
            break
    return received, replies


def replies_in(messages):
    return [signals for name, signals in messages if name == "TransferReply"]


def other_table(job, tolerance=2e-6):
    """The same program, certified for more force: another table, for the same robot."""
    path = job.folder / "other.fct"
    flexcomp("table", "--model", job.model, "--path", job.path, "--tolerance", tolerance, "--force", 3000,
             "--out", path)
    return path.read_bytes()


def corrections(received):
    """The corrections in the answers, one list of six a tick."""
    result = []
    parts = {}
    for name, signals in decoded(received):
        if name.startswith(("Corrected", "Uncorrected")) and not name.endswith("Fd"):
            parts[name] = signals
        if name == "Status" and len(parts) == 6:
            result.append([
                parts["Corrected" + "ABC"[i // 2]][f"q{i + 1}"]
                - parts["Uncorrected" + "ABC"[i // 2]][f"q{i + 1}"] for i in range(6)])
            parts = {}
    return result


def state_of(received):
    """The last that was told."""
    told = of_names(received, "Status")
    return told[-1][1]["state"] if told else None


def states(received):
    return [signals["state"] for name, signals in decoded(received) if name == "Status"]


class HilTest(unittest.TestCase):
    """Limits are those that flexcompd has by itself."""

    VALUE, RATE, ACCELERATION = 0.01, 0.1, 5.0

    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def client(self):
        client = Client()
        self.addCleanup(client.close)
        return client

    def assert_limits(self, received, period):
        """Value, rate and acceleration, from answer to answer; to the steps of the classic signals."""
        step = 4e-7
        sequence = corrections(received)
        self.assertGreater(len(sequence), 10)
        for i in range(6):
            values = [correction[i] for correction in sequence]
            steps = [b - a for a, b in zip(values, values[1:])]
            changes = [b - a for a, b in zip(steps, steps[1:])]
            self.assertLessEqual(max(map(abs, values)), self.VALUE + step)
            self.assertLessEqual(max(map(abs, steps)), self.RATE * period + 2 * step)
            self.assertLessEqual(max(map(abs, changes)), self.ACCELERATION * period**2 + 4 * step)

    def assert_zero(self, received):
        self.assertEqual([0.0] * 6, [round(value, 9) for value in corrections(received)[-1]])
