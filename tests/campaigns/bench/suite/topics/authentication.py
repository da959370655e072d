"""Instructions that authentication takes of a message to send and of one to receive, by callgrind."""

import re

from ..programs import BIN, Failed, run_both
from ..result import Figure, Topic

COUNT = 1000
# Bytes of payload: the message's frames, and its authentication.
MESSAGES = {("setpoint", "classic"): (24, 8), ("wrench", "classic"): (16, 8), ("command", "classic"): (8, 8),
            ("corrected", "classic"): (56, 8), ("setpoint", "fd"): (32, 16), ("wrench", "fd"): (32, 16),
            ("corrected", "fd"): (64, 16)}


def instructions(step, message, layout, count):
    output, errors = run_both("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                              BIN / "bench_authentication", step, message, layout, count)
    if step == "admit" and int(output) != count:
        raise Failed(f"{output.strip()} of {count} messages were taken")
    return int(re.search(r"Collected : (\d+)", errors)[1])


def a_message(step, message, layout):
    """Cost of one more message, so without what it takes to start. Each step contains the one before."""
    return (instructions(step, message, layout, 2 * COUNT) - instructions(step, message, layout, COUNT)) / COUNT


def measure(_):
    figures = []
    for (message, layout), (own, authentication) in MESSAGES.items():
        of = {step: a_message(step, message, layout) for step in ("encode", "seal", "admit")}
        figures.append(Figure(f"{message}, {layout}: to authenticate, {own} + {authentication} bytes of payload",
                              of["seal"] - of["encode"], "instructions"))
        figures.append(Figure(f"{message}, {layout}: to verify", of["admit"] - of["seal"], "instructions"))
    return Topic("Authentication of a message: AES-CMAC by mbedTLS (callgrind; the clock is not counted)",
                 figures, [], [], ("", ""))
