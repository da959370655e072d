"""The machine that the figures were measured on."""

import os
import pathlib
import re
import subprocess

from .programs import BIN, run


def describe():
    """{"processor", "cores", "compiler", "flexcomp"}"""
    text = pathlib.Path("/proc/cpuinfo").read_text()
    processor = re.search(r"^model name\s*: (.*)$", text, re.MULTILINE)
    compiler_path = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", (BIN.parent / "CMakeCache.txt").read_text(), re.MULTILINE)
    compiler = subprocess.run([compiler_path.group(1), "--version"], capture_output=True, text=True, check=True).stdout
    return {"processor": processor.group(1) if processor else os.uname().machine,
            "cores": len(os.sched_getaffinity(0)), "compiler": compiler.splitlines()[0],
            "flexcomp": run(BIN / "flexcomp", "--version").splitlines()[0]}
