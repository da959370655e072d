"""flexcompd against the flexible robot on a bus, circle after circle, in real time: tools/soak.

    soak.py MINUTES

One flexcompd serves all of them. Every circle must be round, memory must not grow, and in the end
flexcompd must end as it should. A line a circle; exit code 1 if something did not hold.
"""

import pathlib
import sys
import tempfile
import time

from bench_on_a_bus import BUS, Flexcompd, Job, circularity, flexcomp

LARGEST_SHARE = 0.05  # of the circularity without compensation
LARGEST_GROWTH = 256  # KiB, from the end of the first circle


def resident(process):
    """KiB of memory that a process has in use."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text()
    return int(status.split("VmRSS:")[1].split()[0])


def mill(job, out, *options):
    flexcomp("plant", "--model", job.model, "--path", job.path, "--out", out, *options)
    return circularity(out)


def soak(folder, minutes):
    """Mills until the time is over; what was wrong, one line each."""
    job = Job(folder, "kr270", 0.05, radius=0.05)
    without = mill(job, folder / "without.csv", "--table", job.table, "--without-compensation")
    wrong = []
    first = None
    circles = 0
    worst = 0
    end = time.monotonic() + 60 * minutes
    with Flexcompd(job) as node:
        while time.monotonic() < end:
            circles += 1
            share = mill(job, folder / "run.csv", "--bus", f"can:{BUS}", "--seed", circles) / without
            memory = resident(node.process)
            first = first or memory
            worst = max(worst, share)
            print(f"circle {circles}: {100 * share:.1f} % of the error is left, {memory} KiB", flush=True)
            if share > LARGEST_SHARE:
                wrong.append(f"circle {circles}: {100 * share:.1f} % of the error is left")
            if memory > first + LARGEST_GROWTH:
                wrong.append(f"circle {circles}: memory has grown from {first} to {memory} KiB")
            time.sleep(0.5)
        if node.stop() != 0:
            wrong.append(f"flexcompd ended with {node.process.returncode}")
        statistics = node.statistics()
    print(f"{circles} circles, {statistics['ticks']} ticks, {statistics['late_ticks']} of them late; "
          f"at worst {100 * worst:.1f} % of the error was left")
    return wrong


def main():
    with tempfile.TemporaryDirectory() as folder:
        wrong = soak(pathlib.Path(folder), float(sys.argv[1]))
    for line in wrong:
        print(f"WRONG: {line}")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
