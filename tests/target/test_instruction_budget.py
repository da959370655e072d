"""The budget of the firmware: instructions of a tick and of its parts, counted in QEMU, and the sizes
of the image. Fails where one has grown by more than 5 % over instruction_budget.json, has shrunk by more
than 20 %, or is above what the image may have; `--update` writes that file anew. Prints a table, and keeps it for tools/test."""

import json
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
BASELINE = HERE / "instruction_budget.json"
BIN = pathlib.Path(os.environ["FLEXCOMP_BIN"])
REPORT = BIN.parent / "instruction_budget.txt"
GROWTH = 1.05
LEAST = 0.8  # below it the counter is not to be trusted, or the baseline is old
LIMITS = {"text": 68 * 1024, "stack_reserved": 8 * 1024}  # bytes


def instructions():
    """Name to ordinary and worst count."""
    done = subprocess.run(
        ["qemu-system-arm", "-machine", "mps2-an500", "-nographic", "-monitor", "none", "-serial", "none",
         "-icount", "shift=6", "-semihosting-config", "enable=on,target=native", "-kernel",
         BIN / "instruction_budget"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True)
    rows = [line.split() for line in done.stdout.splitlines()]
    return {name: {"ordinary": int(ordinary), "worst": int(worst)} for name, ordinary, worst in rows}


def sizes():
    """Bytes of the image by section, without tables from the bus and their slots."""
    done = subprocess.run(["arm-none-eabi-size", "-A", BIN / "flexcomp_firmware.elf"], capture_output=True,
                          text=True, check=True)
    section = {row[0]: int(row[1]) for row in map(str.split, done.stdout.splitlines())
               if len(row) == 3 and row[0].startswith(".")}
    text = sum(section.get(name, 0) for name in (".vectors", ".text", ".ARM.exidx", ".ARM.extab"))
    return {"text": text, "data": section[".data"], "bss": section[".bss"],
            "stack_reserved": section[".stack"] - 256}


def table(counts, image):
    lines = [f"{'instructions on the Cortex-M7':34} {'ordinary':>9} {'worst':>9} {'µs at 216 MHz':>14} "
             f"{'at 480 MHz':>11}"]
    for name, count in counts.items():
        lines.append(f"{name:34} {count['ordinary']:9} {count['worst']:9} {count['worst'] / 216:14.1f} "
                     f"{count['worst'] / 480:11.1f}")
    lines.append("(times: of the worst, estimated at one instruction a cycle)")
    lines.append("image: " + ", ".join(f"{name.replace('_', ' ')} {size} B" for name, size in image.items()))
    return "\n".join(lines)


def changed(found, baseline):
    """Says in sentences which count is more than it was, or much less."""
    return [f"{name}: {value}, was {baseline[name]}" for name, value in found.items()
            if name in baseline and not LEAST * baseline[name] <= value <= GROWTH * baseline[name]]


def flat(counts, image):
    return {f"{name} {kind}": value for name, count in counts.items() for kind, value in count.items()} | {
        f"image {name}": size for name, size in image.items()}


def main():
    counts, image = instructions(), sizes()
    REPORT.write_text(table(counts, image) + "\n")
    print(REPORT.read_text(), end="")
    found = flat(counts, image)
    if sys.argv[1:] == ["--update"]:
        BASELINE.write_text(json.dumps(found, indent=2) + "\n")
        return 0
    baseline = json.loads(BASELINE.read_text())
    complaints = changed(found, baseline)
    complaints += [f"{name}: is not in {BASELINE.name}" for name in found.keys() ^ baseline.keys()]
    complaints += [f"{name}: {image[name]} B, at most {most} B" for name, most in LIMITS.items()
                   if image[name] > most]
    print("\n".join(complaints), end="\n" if complaints else "")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
