"""From setpoint to corrected setpoint on a CAN interface, beside a process that echoes it."""

import pathlib
import re
import tempfile

from ..programs import BIN, KR270, SOURCE, Failed, run
from ..result import Figure, Ratio, Topic

SETPOINTS = 1500  # of each kind
LINE = re.compile(r"^(CAN(?: FD)?) +(echo|node) +([\d.]+) us median +([\d.]+) us 99\.9 %", re.MULTILINE)


def _configure(folder):
    model, path, table = KR270 / "robot.yaml", folder / "path.csv", folder / "t.fct"
    run(BIN / "flexcomp", "plan", "circle", "--model", model, "--center", "1.6,0,1.2", "--plane", "xz", "--out", path)
    run(BIN / "flexcomp", "table", "--model", model, "--path", path, "--out", table)
    run(BIN / "flexcomp", "configure", "--model", model, "--table", table, "--out", folder / "node.toml")
    return folder / "node.toml"


def measure(_):
    with tempfile.TemporaryDirectory() as folder:
        config = _configure(pathlib.Path(folder))
        text = run(SOURCE / "tools" / "vcan", BIN / "bench_can_latency", "vcan0", BIN / "flexcompd", config, SETPOINTS)
    found = {(bus, who): (1e-6 * float(median), 1e-6 * float(late)) for bus, who, median, late in LINE.findall(text)}
    if len(found) != 4:
        raise Failed(f"bench_can_latency: {text.strip()}")
    figures, ratios = [], []
    for bus in ("CAN", "CAN FD"):
        for number, share in enumerate(("median", "99.9 %")):
            echo, node = found[bus, "echo"][number], found[bus, "node"][number]
            figures += [Figure(f"{bus}, bare echo, {share}", echo, "s"), Figure(f"{bus}, flexcompd, {share}", node, "s")]
            ratios.append(Ratio(f"flexcompd / echo, {bus}, {share}", node / echo))
    return Topic("A setpoint's way through flexcompd and back on a virtual CAN interface", figures, ratios, [], ("", ""),
                 ["Classic CAN takes three frames each way, CAN FD one. Where this machine's kernel has no vcan it "
                  "runs in a guest, in which reading the clock is a system call."])
