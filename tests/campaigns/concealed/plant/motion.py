"""Motions that the robot is told to make."""

import dataclasses

import numpy as np


@dataclasses.dataclass
class Motion:
    """Commanded course on an even grid of time, and the force that the process exerts along it."""

    time: np.ndarray  # (n,) s
    q: np.ndarray  # (n, 6) rad, motors
    velocity: np.ndarray  # (n, 6) rad/s
    acceleration: np.ndarray  # (n, 6) rad/s²
    wrench: np.ndarray  # (n, 6) N, N·m on the tool at the TCP, base frame
    temperature: np.ndarray  # (n,) °C
    run_in: float = 0.0  # s from the start that no recording shows

    @property
    def step(self):
        return self.time[1] - self.time[0]


@dataclasses.dataclass
class LoadTest:
    """Postures that the motors hold, each with loads one after another."""

    q: np.ndarray  # (poses, 6) rad
    wrench: np.ndarray  # (poses, loads, 6) N, N·m on the tool at the TCP, base frame
    temperature: np.ndarray  # (poses·loads,) °C


@dataclasses.dataclass
class Signals:
    """The truth, before any sensor saw it: a row a step of the engine, or a settled load."""

    time: np.ndarray  # (n,) s
    q_cmd: np.ndarray  # (n, 6) rad
    q_meas: np.ndarray  # (n, 6) rad, motors
    q_link: np.ndarray  # (n, 6) rad, links
    tau: np.ndarray  # (n, 6) N·m, of the motors, joint side
    wrench: np.ndarray  # (n, 6) N, N·m, base frame
    xyz: np.ndarray  # (n, 3) m, TCP, base frame
    tool: np.ndarray  # (n, 3, 3) rotation of the tool frame in the base frame
    temp_c: np.ndarray  # (n,) °C
    static: bool = False

    def copy(self):
        arrays = {field.name: np.copy(getattr(self, field.name))
                  for field in dataclasses.fields(self) if field.name != "static"}
        return Signals(**arrays, static=self.static)
