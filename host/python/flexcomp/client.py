"""A robot controller's side of the bus."""

import dataclasses
import math
import time

import can

from ._core import Aligned, check, ffi, lib, node_words, reply_words, six, state_name, status_words
from .messages import DATABASE, JOINTS, Sender, decode

OFF, FADING_IN, ACTIVE, HOLDING, FADING_OUT, LATCHED = range(6)  # states
COMMANDS = {"arm": 1, "disarm": 2, "reset": 3, "report": 4}
NOT_READY = 15  # a reply: too few good cycles yet
_ANSWER = ("CorrectedA", "CorrectedB", "CorrectedC", "UncorrectedA", "UncorrectedB", "UncorrectedC", "Status")
_IDENTITY_EVERY = 0.2  # s
_IDENTITIES_AT_ONCE = 10  # a client that starts anew is not heard at first: its counters do not go on
_PATIENCE = 2.0  # s, for an answer in lock-step; for the first one less, as first setpoints are not heard
_PATIENCE_AT_FIRST = 0.05
_GOOD_CYCLES = 20  # before it is asked to arm
_REPLY_WITHIN = 100  # cycles
_ATTEMPTS = 5


class Refused(Exception):
    """A compensator that does not do what it is told: `reply` is the number of its reason, or nothing where
    it does not reply."""

    def __init__(self, command, reply):
        self.reply = reply
        super().__init__(f"{command}: {'nobody answers' if reply is None else reply_words(reply)}")


@dataclasses.dataclass(frozen=True)
class Reply:
    """To a command."""

    command: int
    reply: int
    largest_gain: float


@dataclasses.dataclass(frozen=True)
class Answer:
    """What came of one cycle. `drives` is the setpoint that the robot is to follow (rad): corrected as the
    compensator says, or held and faded by this client where no answer came."""

    drives: tuple
    answered: bool
    corrected: tuple = ()
    uncorrected: tuple = ()
    status: int = 0
    node_status: int = 0
    state: int = OFF

    @property
    def state_name(self):
        """The compensator's state in words."""
        return state_name(self.state)

    @property
    def remarks(self):
        """The bits of both status words, each in words."""
        return status_words(self.status) + node_words(self.node_status)


class _Follower:
    """The C library's: holds and fades where answers cease."""

    def __init__(self, period, hold_time, fade_time):
        self._object = Aligned("flexcomp_follower_t")
        config = ffi.new("flexcomp_follower_config_t *", [period, hold_time, fade_time])
        check(lib.flexcomp_follower_init(self._object.pointer, config), "times of the client")
        self._correction = ffi.new("double[6]")

    def take(self, corrected, uncorrected, off):
        correction = ffi.new("double[6]", [a - b for a, b in zip(corrected, uncorrected)])
        lib.flexcomp_follower_take(self._object.pointer, correction, off)

    def end_period(self):
        lib.flexcomp_follower_end_period(self._object.pointer, self._correction)
        return tuple(self._correction)

    def is_lost(self):
        return lib.flexcomp_follower_is_lost(self._object.pointer)


class Client:
    """Sends setpoints and wrenches and takes answers, over CAN.

    `bus`: an interface such as "can0", or a bus of python-can. `model_hash`: the robot's, as in node.toml.
    `lockstep`: wait for the answer to each setpoint, for a flexcompd with `--trigger lockstep`; else keep
    to `period` (s) in real time. Answers that cease for `hold_time` (s) make it fade over `fade_time`."""

    def __init__(self, bus, model_hash, *, fd=False, lockstep=False, period=0.004, hold_time=0.25, fade_time=0.5):
        self.model_hash = model_hash
        self.period = period
        self.lockstep = lockstep
        self.lost_cycles = 0
        self.reply = None
        self._sender = Sender(fd)
        self._follower = _Follower(period, hold_time, fade_time)
        self._owns_bus = isinstance(bus, str)
        self.bus = can.Bus(interface="socketcan", channel=bus, fd=fd) if self._owns_bus else bus
        self.bus.set_filters([{"can_id": message.frame_id, "can_mask": 0x7FF, "extended": False}
                              for message in DATABASE.messages if "FLEXCOMP" in message.senders])
        self._set = {}
        self._last_counter = None
        self._latest = {}
        self._cycles = 0
        self._named_at = 0.0
        self._next = time.monotonic()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Closes the bus, if this client opened it; of a robot that still moves, `disarm` first."""
        if self._owns_bus:
            self.bus.shutdown()

    @property
    def is_lost(self):
        """Did answers cease, so that the correction fades or has faded, until the compensator has been off?"""
        return self._follower.is_lost()

    def cycle(self, setpoint, wrench=None, saturated=False):
        """One period: sends the wrench on the tool at the TCP (N, N·m; base frame; nothing where another
        sends it), then the setpoint (rad), and takes what comes. Returns an Answer.

        Raises ValueError, before anything is sent, where setpoint or wrench are not six numbers or the setpoint
        is not finite: nothing could be said of where the robot is to go. A wrench that is not finite is sent as
        "not available", which is a fault to the compensator."""
        setpoint = six(setpoint, "setpoint")
        if not all(map(math.isfinite, setpoint)):
            raise ValueError(f"setpoint: expected finite numbers, not {setpoint}")
        wrench = None if wrench is None else six(wrench, "wrench")
        now = time.monotonic()
        self._cycles += 1
        if self._cycles <= _IDENTITIES_AT_ONCE or now - self._named_at >= _IDENTITY_EVERY:
            self._named_at = now
            self._send(self._sender.identity(self.model_hash))
        microseconds = int(1e6 * now) % 2**32
        if wrench is not None:
            self._send(self._sender.wrench(wrench, saturated, microseconds))
        self._send(self._sender.setpoint(setpoint, microseconds))
        self._next = max(self._next + self.period, now)
        patience = _PATIENCE if self._latest else _PATIENCE_AT_FIRST
        answered = self._exchange(now + patience if self.lockstep else self._next)
        self.lost_cycles += not answered
        drives = tuple(q + c for q, c in zip(setpoint, self._follower.end_period()))
        return Answer(drives, answered, **self._latest)

    def request(self, command):
        """Sends "arm", "disarm", "reset" or "report"; `reply` has the answer after one of the next cycles. Raises
        ValueError for another command."""
        if command not in COMMANDS:
            raise ValueError(f"command: expected one of {', '.join(COMMANDS)}, not {command!r}")
        self.reply = None
        self._send(self._sender.command(COMMANDS[command]))

    def arm(self, cycle):
        """Has it armed and waits until it corrects in full; the last answer. `cycle` makes one cycle of
        this client, at a place where the robot stands. Raises Refused."""
        for _ in range(_ATTEMPTS):
            for _ in range(_GOOD_CYCLES):
                cycle()
            reply = self._obtain("arm", cycle)
            if reply != NOT_READY:
                break
        if reply != 0:
            raise Refused("arm", reply)
        return self._until(ACTIVE, cycle, "arm")

    def disarm(self, cycle):
        """Has it faded out, and waits until it is off; the last answer. Raises Refused."""
        reply = self._obtain("disarm", cycle)
        if reply != 0:
            raise Refused("disarm", reply)
        return self._until(OFF, cycle, "disarm")

    def _obtain(self, command, cycle):
        self.request(command)
        for _ in range(_REPLY_WITHIN):
            cycle()
            if self.reply is not None and self.reply.command == COMMANDS[command]:
                return self.reply.reply
        return None

    def _until(self, state, cycle, command):
        for _ in range(round(10 / self.period)):
            answer = cycle()
            if answer.answered and answer.state == state:
                return answer
        raise Refused(command, None)

    def _send(self, frames):
        for frame in frames:
            self.bus.send(frame, timeout=_PATIENCE)

    def _exchange(self, until):
        """Takes frames: in lock-step until the answer is there and nothing waits, else until the time is up.
        Did an answer come?"""
        answered = False
        while True:
            left = 0.0 if self.lockstep and answered else max(0.0, until - time.monotonic())
            frame = self.bus.recv(left)
            if frame is not None:
                answered = self._take(frame) or answered
            elif left == 0:
                return answered

    def _take(self, frame):
        """Does this frame complete an answer?"""
        decoded = decode(frame)
        if decoded is None:
            return False
        name, signals = decoded
        if name == "CommandReply":
            self.reply = Reply(signals["command"], signals["reply"], signals["largest_gain"])
        elif name == "CorrectedFd":
            return self._answer(signals["counter"], [signals[f"q{j}"] for j in JOINTS],
                                [signals[f"uncorrected{j}"] for j in JOINTS], signals)
        elif name in _ANSWER:
            self._set = {other: part for other, part in self._set.items() if part["counter"] == signals["counter"]}
            self._set[name] = signals
            if len(self._set) == len(_ANSWER):
                return self._answer_of_set()
        return False

    def _answer_of_set(self):
        parts, self._set = self._set, {}
        angles = [[parts[f"{kind}{'ABC'[(j - 1) // 2]}"][f"q{j}"] for j in JOINTS]
                  for kind in ("Corrected", "Uncorrected")]
        return self._answer(parts["Status"]["counter"], *angles, parts["Status"])

    def _answer(self, counter, corrected, uncorrected, status):
        if counter == self._last_counter:
            return False  # the same again
        self._last_counter = counter
        state = status["state"]
        self._latest = {"corrected": tuple(corrected), "uncorrected": tuple(uncorrected), "status": status["status"],
                        "node_status": status["node_status"], "state": state}
        self._follower.take(corrected, uncorrected, state in (OFF, LATCHED))
        return True


__all__ = ["Answer", "Client", "Refused", "Reply"]
