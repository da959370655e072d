"""Instructions of a call by Valgrind's callgrind: the same figure in every run on one machine."""

import pathlib
import re
import tempfile

from ..programs import BIN, Failed, run
from ..result import Figure, Ratio, Topic

NAMES = {"floor": "floor: 6×6 matrix times vector", "look_up": "look-up with deflection and correction",
         "tick": "full guarded tick", "direct": "flexcomp, from the model", "pinocchio": "Pinocchio, double",
         "kdl": "Orocos KDL, double"}


def count():
    """{name: instructions a call, the loop around it included}"""
    with tempfile.TemporaryDirectory() as folder:
        calls = int(run("valgrind", "--tool=callgrind", "--instr-atstart=no", "--quiet",
                        f"--callgrind-out-file={folder}/count", BIN / "bench_instructions"))
        counted = {}
        for file in pathlib.Path(folder).iterdir():
            text = file.read_text()
            name = re.search(r"^desc: Trigger: Client Request: (\w+)$", text, re.MULTILINE)
            if name:
                total = re.search(r"^totals: (\d+)$", text, re.MULTILINE)
                counted[name.group(1)] = int(total.group(1)) / calls
    if counted.keys() != NAMES.keys():
        raise Failed(f"callgrind counted {sorted(counted)}")
    return counted


def measure(_):
    first, second = count(), count()
    largest = max(abs(second[name] / first[name] - 1) for name in first)
    if largest > 1e-3:
        raise Failed(f"two counts differ by {100 * largest:.2g} %")
    same = "to the instruction" if largest == 0 else f"but for {100 * largest:.1g} %"
    return Topic(
        "Instructions of a call on the same circle (callgrind)",
        [Figure(text, first[name], "instructions") for name, text in NAMES.items()],
        [Ratio("Pinocchio / look-up", first["pinocchio"] / first["look_up"]),
         Ratio("Pinocchio / guarded tick", first["pinocchio"] / first["tick"]),
         Ratio("look-up / floor", first["look_up"] / first["floor"])],
        [], ("", ""), [f"Counted twice, and the same {same}."])
