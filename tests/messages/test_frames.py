"""The frames of every message, classic and FD, byte for byte as cantools packs them by flexcomp.dbc."""

import os
import pathlib
import re
import subprocess
import unittest

import cantools
import crccheck.crc

SOURCE = pathlib.Path(os.environ["FLEXCOMP_SOURCE"])
DATABASE = cantools.database.load_file(str(SOURCE / "firmware" / "messages" / "flexcomp.dbc"))
PROGRAM = pathlib.Path(os.environ["FLEXCOMP_BIN"]) / "frames_of_messages"
ROUNDS = 2  # each message so often, for its counter

Q = (0.1, -0.2, 0.3, -0.4, 0.5, -0.6)
P = (-1.1, 1.2, -1.3, 1.4, -1.5, 6.7)
WORDS = {f"word{i}": 0xDEADBE00 + i for i in range(14)}


def numbered(values, name="q"):
    return {f"{name}{joint}": value for joint, value in enumerate(values, 1)}


def joint_set(name, q):
    angles = list(numbered(q).items())
    return {f"{name}{part}": dict(angles[2 * i:2 * i + 2]) for i, part in enumerate("ABC")}


# By frame, in the order in which they are sent: the values in one_of_each.hpp.
SETPOINT = joint_set("Setpoint", Q)
SETPOINT_FD = {"SetpointFd": {"timestamp": 123456} | numbered(Q)}
FORCE = {"fx": 440.5, "fy": 1370, "fz": -635, "saturated": 1}
MOMENT = {"mx": 0.25, "my": 3, "mz": 10.5, "saturated": 1}
WRENCH = {"WrenchForce": FORCE, "WrenchMoment": MOMENT}
WRENCH_FD = {"WrenchFd": FORCE | MOMENT | {"timestamp": 234567}}
TRANSFER_DATA = {"TransferData": {"word_index": 77, "word": 0xDEADBE00}}
TRANSFER_DATA_FD = {"TransferDataFd": {"word_index": 77, "words": 1} | WORDS}
STATUS = {"status": 0x00080041, "node_status": 0x5003, "state": 3}
CORRECTED = joint_set("Corrected", Q) | joint_set("Uncorrected", P) | {"Status": STATUS}
CORRECTED_FD = {"CorrectedFd": {"timestamp": 345678} | numbered(Q) | numbered(P, "uncorrected") | STATUS}


def messages(setpoint, wrench, transfer_data, corrected):
    """All of them, with those that have an FD frame as they are given."""
    return setpoint | wrench | {
        "Command": {"command": 1},
        "IdentityLow": {"model_hash_low": 0x89ABCDEF, "wrench_frame": 2},
        "IdentityHigh": {"model_hash_high": 0x01234567},
        "TransferBegin": {"size": 10272, "table_crc": 0xCAFEBABE},
    } | transfer_data | {
        "TransferEnd": {"table_crc": 0xBABECAFE},
    } | joint_set("Measured", P) | {
        "MeasuredPositionXY": {"x": 1.6, "y": -0.1},
        "MeasuredPositionZ": {"z": 1.2},
    } | corrected | {
        "Heartbeat": {"uptime": 12345, "state": 2, "slot": 1, "table_result": 14},
        "Latched": {"latched_faults": 0x21, "node_latched_faults": 0x81},
        "TableLow": {"model_hash_low": 0x76543210, "largest_gain": 0.5},
        "TableHigh": {"model_hash_high": 0xFEDCBA98},
        "Fault": {"code": 0x7105, "active": 1, "detail": 42},
        "Statistic": {"name": 64, "value": 123456789},
        "TransferReply": {"stage": 3, "result": 12, "words": 2568},
        "CommandReply": {"command": 3, "reply": 33, "largest_gain": 0.25},
    }


EXPECTED = {"classic": messages(SETPOINT, WRENCH, TRANSFER_DATA, CORRECTED),
            "fd": messages(SETPOINT_FD, WRENCH_FD, TRANSFER_DATA_FD, CORRECTED_FD)}


def checksum(message, payload):
    protected = message.dbc.attributes["E2EDataId"].value.to_bytes(2, "little")
    if message.is_fd:
        return crccheck.crc.Crc16Ibm3740.calc(protected + payload[2:])
    return crccheck.crc.Crc8Autosar.calc(protected + payload[1:])


def packed(name, counter, signals):
    """The frame as the program prints it."""
    message = DATABASE.get_message_by_name(name)
    signals = signals | {"counter": counter, "crc": 0}
    payload = message.encode(signals)
    payload = message.encode(signals | {"crc": checksum(message, payload)})
    return message.frame_id, message.is_fd, payload.hex()


class Frames(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        printed = subprocess.run([PROGRAM], capture_output=True, text=True, check=True).stdout
        cls.rows = [row.split() for row in printed.splitlines()]

    def frames(self, encoding):
        return [(int(identifier), fd == "1", payload)
                for name, identifier, fd, payload in self.rows if name == encoding]

    def test_each_frame_is_as_cantools_packs_it(self):
        for encoding, frames in EXPECTED.items():
            expected = [packed(name, counter, signals)
                        for counter in range(ROUNDS) for name, signals in frames.items()]
            self.assertEqual(expected, self.frames(encoding))

    def test_no_frame_of_the_database_is_left_out(self):
        sent = EXPECTED["classic"].keys() | EXPECTED["fd"].keys()
        every = {message.name for message in DATABASE.messages}
        self.assertEqual({name for name in every if not name.endswith("Authentication")}, sent)


class PageOfTheController(unittest.TestCase):
    """The frames that firmware/client/README.md gives to test a codec with."""

    ROW = re.compile(r"^\| `(\w+)` \| (0x\w+) \| `([0-9A-F ]+)` \| `([0-9A-F ]+)` \|$", re.MULTILINE)

    def test_they_are_those_of_the_dbc(self):
        rows = self.ROW.findall((SOURCE / "firmware" / "client" / "README.md").read_text())
        self.assertEqual(["SetpointA", "SetpointB", "SetpointC", "SetpointFd"], [row[0] for row in rows])
        for name, identifier, over, data in rows:
            message, payload = DATABASE.get_message_by_name(name), bytes.fromhex(data)
            self.assertEqual(message.frame_id, int(identifier, 16))
            signals = message.decode(payload)
            self.assertEqual(0, signals["counter"])
            for joint, angle in enumerate(Q, 1):
                self.assertAlmostEqual(angle, signals.get(f"q{joint}", angle), delta=1e-7)
            self.assertEqual(signals.get("timestamp", 123456), 123456)
            crc = crccheck.crc.Crc16Ibm3740 if message.is_fd else crccheck.crc.Crc8Autosar
            self.assertEqual(signals["crc"], crc.calc(bytes.fromhex(over)))
            self.assertEqual(signals["crc"], checksum(message, payload))


if __name__ == "__main__":
    unittest.main()
