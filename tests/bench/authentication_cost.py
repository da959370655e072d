"""Usage: tests/bench/authentication_cost.py PROGRAM

Counts (valgrind) the instructions that authentication takes: a message to send, and one to receive. PROGRAM is
bench_authentication. What encoder and decoder take is there to compare. The clock is not counted.
"""

import re
import subprocess
import sys

COUNT = 1000
# Bytes of payload: the message's frames, and its authentication.
MESSAGES = {("setpoint", "classic"): (24, 8), ("wrench", "classic"): (16, 8), ("command", "classic"): (8, 8),
            ("corrected", "classic"): (56, 8), ("setpoint", "fd"): (32, 16), ("wrench", "fd"): (32, 16),
            ("corrected", "fd"): (64, 16)}


def instructions(program, step, message, layout, count):
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, step, message,
                           layout, str(count)], capture_output=True, text=True, check=False)
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or not found:
        sys.exit(f"{program} under valgrind: {done.stderr.strip()[-300:]}")
    if step in ("decode", "admit") and int(done.stdout) != count:
        sys.exit(f"{program}: {done.stdout.strip()} of {count} messages were taken")
    return int(found[1])


def a_message(program, step, message, layout):
    """Of one more message, so without what it takes to start."""
    return (instructions(program, step, message, layout, 2 * COUNT)
            - instructions(program, step, message, layout, COUNT)) / COUNT


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print(f"{'instructions a message':24}{'encode':>8}{'decode':>8}{'seal':>8}{'admit':>8}   bytes of payload")
    for (message, layout), (own, authentication) in MESSAGES.items():
        of = {step: a_message(sys.argv[1], step, message, layout) for step in ("encode", "decode", "seal", "admit")}
        print(f"{message + ', ' + layout:24}{of['encode']:8.0f}{of['decode'] - of['encode']:8.0f}"
              f"{of['seal'] - of['encode']:8.0f}{of['admit'] - of['seal']:8.0f}   {own} + {authentication}", flush=True)


if __name__ == "__main__":
    main()
