"""EMPS: a motor, a ball screw and a carriage under position control.

Recording: A. Janot, M. Gautier, M. Brunot, "Data set and reference models of EMPS", Workshop on
Nonlinear System Identification Benchmarks 2019, in the copy github.com/wmkouw/NSI-EMPS, commit
d1137b8 (MIT; the authors of the data state no licence).

The carriage is a slide (`single_axis`). The model knows its mass, 95 kg, and nothing
else: all friction, and what tells the directions apart, is left out; so are the screw's elasticity
and the amplifier's lag of some tenths of a millisecond. Force is drive gain times voltage.

The column force_pulse_N of the second run is no external force, and no wrench is written: it is a
square wave of 5 V in the voltage itself, which jumps by 5.07 V where the column does.
"""

import numpy as np

from .. import single_axis
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import Damaged, read_table

TITLE = "EMPS, a carriage on a ball screw"
LEFT_OUT = "all friction"
FOLDER = "emps"
TRAINING, HELD_OUT = "DATA_EMPS.csv", "DATA_EMPS_PULSES.csv"
FILES = [TRAINING, HELD_OUT]

MASS = 95.0  # kg
DRIVE_GAIN = 35.1507  # N/V
CUTOFF = 15.0  # Hz
SPREAD = 0.1  # s, half the length of the filter
KEPT_EACH = 4


def low_pass(signal, step):
    """A sinc under a Hann window, without delay: (n,) at steps of seconds -> the rows that it
    reaches.

    Force and position both pass through it. Inertia and viscous friction commute with a filter.
    Without one, force steps of 178 N and 10 ms stand beside accelerations that any differentiation
    spreads over tens of milliseconds, and what is left (16 % of the force) tells bandwidths apart,
    not physics.
    """
    half = round(SPREAD / step)
    lag = np.arange(-half, half + 1)
    weight = np.sinc(2 * CUTOFF * step * lag) * np.cos(0.5 * np.pi * lag / (half + 1)) ** 2
    return np.convolve(signal, weight / weight.sum(), "valid")


def read(path):
    """Time (n,) s, travel (n,) m, force (n,) N, after the filter and at a quarter of the rate."""
    run = read_table(path, ["t_s", "q_meas_m", "vir_V"], rising="t_s")
    step = float(np.median(np.diff(run["t_s"])))
    lost = round(SPREAD / step)
    if len(run["t_s"]) <= 4 * lost:
        raise Damaged(f"{path}: is shorter than its filter needs")
    return (run["t_s"][lost:-lost][::KEPT_EACH], low_pass(run["q_meas_m"], step)[::KEPT_EACH],
            low_pass(DRIVE_GAIN * run["vir_V"], step)[::KEPT_EACH])


def write(data, folder):
    """One experiment: the smooth run to learn from, the one with the square wave held out."""
    model = write_robot(folder, single_axis.chain("EMPS carriage", MASS))
    smooth = single_axis.write(folder / "smooth.csv", *read(data / TRAINING))
    pulses = single_axis.write(folder / "pulses.csv", *read(data / HELD_OUT))
    return [Experiment("force", model, [smooth], pulses)]
