"""The controller: position and velocity loop on each motor, with computed torque fed forward."""

import mujoco
import numpy as np
from scipy.interpolate import CubicSpline

from . import assembly

POSITION_BANDWIDTH = 600.0  # rad/s, against the rotor alone
DAMPING = 0.9
SLOWEST_MODE = 25.0  # rad/s: the integral must stay slower, or it feeds the arm's vibration
SMOOTH_SPEED = 3e-4  # rad/s: friction fed forward turns over this
COARSE = 4e-3  # s between computed torques


def holding_torque(description, motion):
    """Torque (n, 6) in N·m that holds a rigid robot against the wrench of a motion."""
    model = assembly.rigid(description)
    data, site = mujoco.MjData(model), model.site("tcp").id
    stride = max(1, round(COARSE / motion.step))
    rows = np.unique(np.append(np.arange(0, len(motion.time), stride), len(motion.time) - 1))
    held, moves, turns = np.empty((len(rows), 6)), np.zeros((3, 6)), np.zeros((3, 6))
    for index, row in enumerate(rows):
        data.qpos[:] = motion.q[row]
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        mujoco.mj_jacSite(model, data, moves, turns, site)
        held[index] = -moves.T @ motion.wrench[row, :3] - turns.T @ motion.wrench[row, 3:]
    return CubicSpline(motion.time[rows], held)(motion.time)


def computed_torque(description, motion):
    """Torque (n, 6) in N·m that a rigid robot with the described friction needs for a motion."""
    model = assembly.rigid(description)
    data = mujoco.MjData(model)
    stride = max(1, round(COARSE / motion.step))
    rows = np.unique(np.append(np.arange(0, len(motion.time), stride), len(motion.time) - 1))
    rigid = np.empty((len(rows), 6))
    for index, row in enumerate(rows):
        data.qpos[:], data.qvel[:] = motion.q[row], motion.velocity[row]
        data.qacc[:] = motion.acceleration[row]
        mujoco.mj_inverse(model, data)
        rigid[index] = data.qfrc_inverse
    torque = CubicSpline(motion.time[rows], rigid)(motion.time)
    torque += description.column("rotor_inertia") * motion.acceleration
    torque += description.column("viscous") * motion.velocity
    return torque + description.column("coulomb") * np.tanh(motion.velocity / SMOOTH_SPEED)


class Servo:
    """Torques of the six motors from command and encoders.

    lag: (6,) s. A joint with a lag has no velocity fed forward: its velocity loop, of proportional
    and integral gain, is told (command - angle)/lag, so that the joint follows as a first-order lag
    (Siciliano et al. 2009, section 8). Its integral is slow enough that both loops together take
    energy from every vibration of the arm.
    """

    def __init__(self, description, motion):
        inertia = np.maximum(description.column("rotor_inertia"), 1e-3)
        self._damping = 2 * DAMPING * POSITION_BANDWIDTH * inertia
        self._stiffness = POSITION_BANDWIDTH**2 * inertia
        self._integral = 0.2 * SLOWEST_MODE**2 * self._damping
        self._motion = motion
        self._forward = computed_torque(description, motion)
        self._sum = np.zeros(6)
        self.lag = np.zeros(6)
        self._wanted = motion.q[0].copy()  # integral of the velocity that lagging joints are told

    def set_lag(self, joints, constant):
        """Gives joints (numbers from 0) a first-order lag of `constant` s."""
        self.lag[joints] = constant
        # Integral and lag together give back rate/(constant w²) of what the proportional gain takes
        # from a vibration at w rad/s.
        rate = 0.8 * constant * SLOWEST_MODE**2
        self._stiffness[joints] = rate * self._damping[joints]
        self._integral[joints] = 0.0

    def torque(self, row, q, velocity):
        error = self._motion.q[row] - q
        speed_error = self._motion.velocity[row] - velocity
        if self.lag.any():
            slow = self.lag > 0
            told = error[slow] / self.lag[slow]
            self._wanted[slow] += told * self._motion.step
            speed_error[slow] = told - velocity[slow]
            error[slow] = self._wanted[slow] - q[slow]
        self._sum += error * self._motion.step
        return (self._forward[row] + self._stiffness * error + self._damping * speed_error
                + self._integral * self._sum)

    def feed_forward(self, torque):
        """Adds torques (n, 6) in N·m, of something that the controller knows beforehand."""
        self._forward = self._forward + torque
