"""Motions of an arm with its torques, as `python3 -m flexcomp.convert` makes them of bags of joint states."""

from .robot_files import write_robot
from .study import Experiment
from .tables import read_table, stacked, write_recording


def read(path, joints):
    """Time (n,) s, angles (n, joints) rad, torques (n, joints) N·m."""
    numbers = range(1, joints + 1)
    groups = ("q_meas_{}", "tau_{}")
    columns = [form.format(number) for form in groups for number in numbers]
    table = read_table(path, ["t", *columns], rising="t")
    return table["t"], *(stacked(table, form, numbers) for form in groups)


def write(path, folder, chain, training_part):
    """One experiment: what follows on the first part of the motion is held out."""
    time, angle, torque = read(path, len(chain.joints))
    model = write_robot(folder, chain)
    is_training = time <= training_part * time[-1]
    training, held_out = (
        write_recording(folder / f"{name}.csv", time[rows], q_meas=angle[rows], tau=torque[rows])
        for name, rows in (("training", is_training), ("held_out", ~is_training)))
    return [Experiment("torques", model, [training], held_out)]
