"""A banded rotary friction damper with play, driven to and fro by two actuators.

Recording: Lehigh University, April 2023, in
github.com/ARTS-Laboratory/Dataset-Friction-Damper-with-Backlash, commit 0e09aa9 (CC BY-SA 4.0):
sinusoids that swell and fade, at 0.5 and 1 Hz, 25 and 38 mm, bands tensioned by 36 lb. Thinned out
to 128 Hz (0.5 Hz runs) and 256 Hz (1 Hz runs).

The damper is a slide (`single_axis`) without mass or friction, so the model predicts
no force at all. Left out besides: the device's inertia and the actuators. The run held out has the
lower speed and the larger amplitude; each of the two, but not both together, is in the training.
"""

from .. import single_axis
from ..robot_files import write_robot
from ..study import Experiment
from ..tables import read_table

TITLE = "Rotary friction damper with play"
LEFT_OUT = "everything: friction, hysteresis, play"
FOLDER = "friction_backlash_damper"
TRAINING = ("0.5Hz36lbtension1amplitude", "1Hz36lbtension1amplitude", "1Hz36lbtension1.5amplitude")
HELD_OUT = "0.5Hz36lbtension1.5amplitude"
FILES = [f"{run}.csv" for run in (*TRAINING, HELD_OUT)]

INCH = 0.0254  # m
KIP = 4448.2216  # N, a thousand pounds


def read(path):
    """Time (n,) s, displacement (n,) m, friction force (n,) N."""
    run = read_table(path, ["t_s", "displacement_in", "friction_force_kip"], rising="t_s")
    return run["t_s"], INCH * run["displacement_in"], KIP * run["friction_force_kip"]


def write(data, folder):
    """One experiment: three runs to learn from, one held out."""
    model = write_robot(folder, single_axis.chain("Friction damper", mass=0.0))
    written = {run: single_axis.write(folder / f"{run}.csv", *read(data / f"{run}.csv"))
               for run in (*TRAINING, HELD_OUT)}
    return [Experiment("force", model, [written[run] for run in TRAINING], written[HELD_OUT])]
