"""Base of all concealed effects."""

import dataclasses

import numpy as np

ALL_JOINTS = (1, 2, 3, 4, 5, 6)


@dataclasses.dataclass
class Scale:
    """Motions and loads of a case's recordings: effects are drawn in proportion, and probed."""

    load: np.ndarray  # (6,) N·m, largest load about each joint
    force: float  # N, largest on the tool; 0 without a wrench
    torque: np.ndarray  # (6,) N·m, largest motor torque
    speed: np.ndarray  # (6,) rad/s, largest of each joint
    acceleration: np.ndarray  # (6,) rad/s²
    span: np.ndarray  # (6,) rad, range of each joint


class Effect:
    """One entry of the catalogue.

    name        as in diagnosis.json
    joints      those it can sit at; (None,) if it has none
    groups      measured groups whose residual it changes
    kinds       kinds of recording it is concealed in
    hints       what a recording needs for it, for `kinds.draw`
    units       of its parameters
    alters_model  it changes the robot's own numbers
    """

    name = ""
    joints = (None,)
    groups = ()
    kinds = ()
    hints = {}
    units = {}
    alters_model = False

    def draw(self, rng, joint, robot, scale):
        """A realistic size: {parameter: value}, SI units."""
        raise NotImplementedError

    def apply(self, machine, joint, parameters):
        """Conceals it in the machine."""
        raise NotImplementedError

    def probes(self, joint, robot, scale):
        """Shapes that it could have, to judge whether another effect's trace could be taken for it: a
        list of families; the trace of a family is any sum of traces of its members."""
        raise NotImplementedError


def one(machine, joint):
    """Index and unit vector of a joint."""
    k = joint - 1
    return k, np.eye(6)[k]


def log_uniform(rng, low, high):
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def signed(rng, low, high):
    return float(rng.choice([-1, 1])) * log_uniform(rng, low, high)


def direction(rng):
    vector = rng.normal(size=3)
    return vector / np.linalg.norm(vector)


def vector_parameters(names, vector):
    return {name: float(value) for name, value in zip(names, vector)}


def unit_probes(names, size):
    """One member a parameter: a family that holds every mixture of them."""
    return [{other: (size if other == name else 0.0) for other in names} for name in names]
