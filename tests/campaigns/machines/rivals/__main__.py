"""Runs one rival on one experiment, in a Python that has its packages; called by `comparison`."""

import argparse
import importlib
import json
import pathlib
import sys
import time

import numpy as np

from ..tables import write_recording
from . import motion, regression

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
    nominal = motion.nominal(options.model)
    cutoff = regression.best_cutoff(nominal, options.recording)
    training = [motion.read(path, cutoff) for path in options.recording]
    held_out = motion.read(options.holdout, cutoff)
    start = time.process_time()
    torque, missing = rival.predict(nominal, training, held_out)
    write_recording(options.out, held_out.time, tau=torque)
    json.dump({"seconds": time.process_time() - start, "cutoff": cutoff, "missing": missing}, sys.stdout)
    return 0 if np.isfinite(torque).all() else 1


if __name__ == "__main__":
    sys.exit(main())
