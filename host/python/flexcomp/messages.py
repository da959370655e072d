"""Messages by flexcomp.dbc: cantools packs and unpacks the frames, crccheck protects them."""

import math
import pathlib

import can
import cantools
import crccheck.crc

DATABASE = cantools.database.load_file(str(pathlib.Path(__file__).parent / "flexcomp.dbc"))
JOINTS = range(1, 7)
WRENCH = ("fx", "fy", "fz", "mx", "my", "mz")
BASE_FRAME = 1


def checksum(message, payload):
    """Over the data identifier, low byte first, and what follows the checksum in the payload."""
    protected = message.dbc.attributes["E2EDataId"].value.to_bytes(2, "little")
    if message.is_fd:
        return crccheck.crc.Crc16Ibm3740.calc(protected + bytes(payload[2:]))
    return crccheck.crc.Crc8Autosar.calc(protected + bytes(payload[1:]))


def decode(frame):
    """Name and signals of a frame; nothing for one that is damaged or not of flexcomp."""
    if frame.is_error_frame or frame.is_remote_frame or frame.is_extended_id:
        return None
    try:
        message = DATABASE.get_message_by_frame_id(frame.arbitration_id)
        if frame.is_fd != message.is_fd or len(frame.data) != message.length:
            return None
        signals = message.decode(bytes(frame.data), decode_choices=False)
    except (KeyError, cantools.database.errors.DecodeError):
        return None
    if signals["crc"] != checksum(message, frame.data):
        return None
    return message.name, {signal.name: _value(signal, signals[signal.name]) for signal in message.signals}


def _is_scaled(signal):
    """Signed, in steps: its most negative raw value means "not available"."""
    return signal.is_signed and not signal.is_float and signal.scale != 1


def _value(signal, value):
    return math.nan if _is_scaled(signal) and value < signal.minimum else value


def _sent(signal, value):
    """A value that is not finite or does not fit never wraps around: it becomes "not available"."""
    if _is_scaled(signal) and not signal.minimum <= value <= signal.maximum:
        return -signal.scale * 2 ** (signal.length - 1)
    return value


class Sender:
    """Makes the frames of messages. Those of one message share a counter."""

    def __init__(self, fd):
        self.fd = fd
        self._counters = {}

    def setpoint(self, q, microseconds):
        """Of an uncorrected setpoint, rad."""
        angles = {f"q{joint}": float(angle) for joint, angle in zip(JOINTS, q, strict=True)}
        if self.fd:
            return self.frames("SetpointFd", timestamp=microseconds, **angles)
        return self.frames("SetpointA", "SetpointB", "SetpointC", **angles)

    def wrench(self, wrench, saturated, microseconds):
        """Of a wrench on the tool at the TCP, base frame, N and N·m."""
        values = {name: float(value) for name, value in zip(WRENCH, wrench, strict=True)}
        if self.fd:
            return self.frames("WrenchFd", timestamp=microseconds, saturated=saturated, **values)
        return self.frames("WrenchForce", "WrenchMoment", saturated=saturated, **values)

    def identity(self, model_hash):
        return self.frames("IdentityLow", "IdentityHigh", model_hash_low=model_hash & 0xFFFFFFFF,
                           model_hash_high=model_hash >> 32, wrench_frame=BASE_FRAME)

    def command(self, number):
        return self.frames("Command", command=number)

    def frames(self, *names, **signals):
        """Of one message, by the names of its frames."""
        counter = self._counters.get(names, 0)
        self._counters[names] = counter + 1
        return [self._frame(DATABASE.get_message_by_name(name), counter, signals) for name in names]

    def _frame(self, message, counter, signals):
        values = {signal.name: _sent(signal, signals.get(signal.name, 0)) for signal in message.signals}
        values["counter"] = counter % (256 if message.is_fd else 16)
        payload = message.encode(values | {"crc": 0}, strict=False)
        payload = message.encode(values | {"crc": checksum(message, payload)}, strict=False)
        return can.Message(arbitration_id=message.frame_id, data=payload, is_extended_id=False,
                           is_fd=message.is_fd, bitrate_switch=message.is_fd)
