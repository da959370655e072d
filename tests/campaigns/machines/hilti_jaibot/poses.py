"""The static poses of a JaiBot at one site."""

import dataclasses

import numpy as np
import yaml

from ..tables import Damaged, read_text

KINDS = ("stationing_measurements", "evaluation_measurements")


@dataclasses.dataclass
class Poses:
    """A row a pose: column (n,) m; arm (n, 6) rad; prism (n, 3) m in the total station's frame;
    specific forces (n, 3) m/s² at the base and at the column's top."""

    column: np.ndarray
    arm: np.ndarray
    prism: np.ndarray
    base_force: np.ndarray
    top_force: np.ndarray


def read(path, height, branch):
    """Poses at a column height (m, as the file names it) in one branch of the arm's inverse
    kinematics."""
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    try:
        at_height = yaml.load(read_text(path), Loader=loader)["column_heights"][height]
        solution = at_height["solution_spaces"][branch]
        poses = [pose for kind in KINDS for pose in solution.get(kind) or []]
        states = np.array([pose["joint_states"] for pose in poses], float).reshape(-1, 7)
        prism, base, top = (
            np.array([pose[key] for pose in poses], float).reshape(-1, 3)
            for key in ("prism_position", "tilt_sensor_base_accel", "tilt_sensor_column_accel"))
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        place = f":{mark.line + 1}" if mark else ""
        raise Damaged(f"{path}{place}: {getattr(error, 'problem', None) or 'no YAML'}") from error
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise Damaged(f"{path}: poses at {height} m, branch {branch}: {error!r}") from error
    if len(states) == 0:
        raise Damaged(f"{path}: no poses at {height} m in branch {branch}")
    return Poses(states[:, 0], states[:, 1:], prism, base, top)
