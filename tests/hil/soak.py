"""flexcompd against the flexible robot on a bus, circle after circle, in real time: tools/soak.

    soak.py MINUTES

One flexcompd serves all of them. Every circle must be round, memory must not grow, ticks must not come
late more often as time goes on, the counters must fit each other and a bus without faults, and in the
end flexcompd must end as it should. A line a circle; exit code 1 if something did not hold.
"""

import pathlib
import signal
import statistics
import sys
import tempfile
import time

from bench_on_a_bus import BUS, Flexcompd, Job
from circle_on_a_bus import LARGEST_SHARE, REAL_TIME_PERIOD, mill

LARGEST_GROWTH = 256  # KiB, from the end of the first circle
FAULTLESS = ("corrupt", "contradicting", "incomplete")


def resident(process):
    """KiB of memory that a process has in use."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0])


def counters(node):
    """Its counters, by now."""
    node.statistics_file.unlink(missing_ok=True)
    node.process.send_signal(signal.SIGUSR1)
    latest = time.monotonic() + 10
    while not node.statistics_file.exists() and time.monotonic() < latest:
        time.sleep(0.02)
    return node.statistics()


def wrong_counters(counted, circles):
    """Contradictions, one line each."""
    wrong = [f"{stream}: {counted[stream][name]} {name}"
             for stream in ("setpoint", "wrench") for name in FAULTLESS if counted[stream][name]]
    for stream in ("setpoint", "wrench"):  # each circle's sender begins to count anew
        if counted[stream]["out_of_sequence"] >= circles:
            wrong.append(f"{stream}: {counted[stream]['out_of_sequence']} out of sequence in {circles} circles")
    answered = sum(counted["latency_log2_us"])
    received = counted["setpoint"]["received"]
    if not 0.95 * received <= answered <= received:
        wrong.append(f"{answered} answers to {received} setpoints")
    return wrong


def grown(late):
    """Do late ticks come more often in the last quarter of the circles than in the first?"""
    quarter = max(len(late) // 4, 1)
    before, after = statistics.median(late[:quarter]), statistics.median(late[-quarter:])
    return [f"{after} late ticks a circle, {before} to begin with"] if after > 2 * before + 5 else []


def soak(folder, minutes):
    """Mills until the time is over; what was wrong, one line each."""
    job = Job(folder, "kr270", 0.05, radius=0.05, period=REAL_TIME_PERIOD)
    without, _ = mill(job, folder / "without.csv", "--table", job.table, "--without-compensation")
    wrong = []
    first = None
    late = []
    refused = 0
    worst = 0
    end = time.monotonic() + 60 * minutes
    with Flexcompd(job) as node:
        while time.monotonic() < end:
            circle = len(late) + refused + 1
            try:
                after, unanswered = mill(job, folder / "run.csv", "--bus", f"can:{BUS}", "--seed", circle)
            except AssertionError as failure:  # not armed, though asked again
                refused += 1
                wrong.append(f"circle {circle}: {' '.join(str(failure).split())}")
                continue
            share = after / without
            memory = resident(node.process)
            first = first or memory
            worst = max(worst, share)
            late.append(counters(node)["late_ticks"] - sum(late))
            print(f"circle {circle}: {100 * share:.1f} % of the error is left, {100 * unanswered:.1f} % of the "
                  f"cycles without an answer in time, {late[-1]} late ticks, {memory} KiB", flush=True)
            if share > LARGEST_SHARE:
                wrong.append(f"circle {circle}: {100 * share:.1f} % of the error is left")
            if memory > first + LARGEST_GROWTH:
                wrong.append(f"circle {circle}: memory has grown from {first} to {memory} KiB")
            time.sleep(0.5)
        if node.stop() != 0:
            wrong.append(f"flexcompd ended with {node.process.returncode}")
        counted = node.statistics()
    print(f"{len(late)} circles and {refused} refused, {counted['ticks']} ticks, {counted['late_ticks']} of them late; "
          f"at worst {100 * worst:.1f} % of the error was left")
    return wrong + wrong_counters(counted, len(late) + refused) + grown(late)


def main():
    with tempfile.TemporaryDirectory() as folder:
        wrong = soak(pathlib.Path(folder), float(sys.argv[1]))
    for line in wrong:
        print(f"WRONG: {line}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
