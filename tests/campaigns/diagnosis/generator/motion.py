"""A motion of the joints on an even time grid."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Track:
    time: np.ndarray  # (n,) s, even
    q: np.ndarray  # (n, 6) rad
    velocity: np.ndarray
    acceleration: np.ndarray

    @property
    def step(self):
        return self.time[1] - self.time[0]
