"""Runs one rival on one experiment, in a Python that has its packages; called by `comparison`."""

import argparse
import importlib
import json
import pathlib
import sys
import time

import numpy as np

from ..tables import write_recording
from . import motion

RIVALS = ("regression", "figaroh_identification", "mujoco_sysid")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rival", choices=RIVALS)
    parser.add_argument("--model", type=pathlib.Path, required=True)
    parser.add_argument("--recording", type=pathlib.Path, action="append", required=True)
    parser.add_argument("--holdout", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True)
    options = parser.parse_args()
    rival = importlib.import_module(f"{__package__}.{options.rival}")
    training, held_out = [motion.read(path) for path in options.recording], motion.read(options.holdout)
    start = time.process_time()
    torque, missing = rival.predict(motion.nominal(options.model), training, held_out)
    write_recording(options.out, held_out.time, tau=torque)
    json.dump({"seconds": time.process_time() - start, "missing": missing}, sys.stdout)
    return 0 if np.isfinite(torque).all() else 1


if __name__ == "__main__":
    sys.exit(main())
