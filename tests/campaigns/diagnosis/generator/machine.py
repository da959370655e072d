"""A robot with all the physics it really has, and what its sensors would show, free of noise.

The simulation of `flexcomp diagnose` knows the robot model alone. A Machine adds what is concealed:
each effect of the catalogue changes one of the fields below.
"""

import dataclasses

import numpy as np
from scipy.interpolate import CubicSpline

from . import dynamics, elasticity
from .kinematics import jacobian, posture, turn
from .memory import first_order_lag
from .motion import Track
from .robot import JOINTS, Robot


@dataclasses.dataclass
class Drive:
    """Motion of the robot, on an even grid of n samples."""

    track: Track  # commanded motion
    wrench: np.ndarray  # (n, 6), truly acting on the tool, base frame
    temperature: np.ndarray  # (n,), °C
    static: bool = False  # rows are poses at rest, not samples of a motion
    loads: dict = dataclasses.field(default_factory=dict)  # joint loads already computed, by robot
    predictions: dict = dataclasses.field(default_factory=dict)  # as `trace` has made them


@dataclasses.dataclass
class State:
    """The motors' motion and the load on the joints; all (n, 6)."""

    time: np.ndarray
    q: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    wrench: np.ndarray
    temperature: np.ndarray
    static_load: np.ndarray | None = None  # about the joint, on the link: wrench and weight
    dynamic_load: np.ndarray | None = None  # the same with the link's inertia


@dataclasses.dataclass
class Machine:
    robot: Robot
    springs: list = dataclasses.field(default_factory=list)  # besides the robot's own
    lag: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(JOINTS))  # s
    zero: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(JOINTS))  # rad, true − read
    balance: object = None  # q_link (n, 6) -> torque (n, 6) between links, on the link
    transmission: list = dataclasses.field(default_factory=list)  # State -> (n, 6) rad, no load needed
    memory: list = dataclasses.field(default_factory=list)  # (State, load (n, 6)) -> (n, 6) rad
    shift: list = dataclasses.field(default_factory=list)  # (State, tool rotation) -> (n, 3) m
    torque: list = dataclasses.field(default_factory=list)  # State -> (n, 6) N·m
    sensor: list = dataclasses.field(default_factory=list)  # tool-frame wrench (n, 6) -> the same
    late: dict = dataclasses.field(default_factory=dict)  # group of columns -> s behind the encoders


GROUPS = ("q_meas", "q_link", "tau", "wrench", "xyz")


def nominal(robot):
    return Machine(robot)


def motors(machine, drive):
    """How the motors move, at every sample."""
    track = drive.track
    if machine.lag.any() and not drive.static:
        track = first_order_lag(track, machine.lag)
    return State(track.time, track.q, track.velocity, track.acceleration, drive.wrench,
                 drive.temperature)


def _link_torque(robot, state, q):
    """Torque that the drive must give at the link: rigid dynamics less the wrench (n, 6)."""
    place = posture(robot, q)
    return (dynamics.inverse_dynamics(robot, q, state.velocity, state.acceleration)
            - np.einsum("nij,ni->nj", jacobian(place), state.wrench))


def _with_loads(machine, drive, state):
    """The state with its joint loads. Machines that differ from one another neither in their robot
    nor in where their motors stand share the computation."""
    shared = not (machine.lag.any() or machine.zero.any() or machine.balance)
    if shared and id(machine.robot) in drive.loads:
        return dataclasses.replace(state, **drive.loads[id(machine.robot)][1])
    robot, q = machine.robot, state.q + machine.zero
    still = dataclasses.replace(state, velocity=0 * q, acceleration=0 * q)
    balance = machine.balance(q) if machine.balance else 0
    loads = {"static_load": balance - _link_torque(robot, still, q),
             "dynamic_load": balance - _link_torque(robot, state, q)}
    if shared:
        drive.loads[id(robot)] = robot, loads  # holding the robot keeps its id its own
    return dataclasses.replace(state, **loads)


def measure(machine, drive, groups, rows=None):
    """The columns `groups` (of GROUPS) without noise, at sample numbers `rows` (may be fractions)."""
    state = motors(machine, drive)
    if machine.memory or machine.torque:
        state = _with_loads(machine, drive, state)
    n = len(state.time)
    play = {kind: np.zeros((n, JOINTS)) for kind in ("static", "dynamic")}
    for term in machine.transmission:
        for kind in play:
            play[kind] += term(state)
    for term in machine.memory:
        play["static"] += term(state, state.static_load)
        play["dynamic"] += term(state, state.dynamic_load)
    extra = sum((term(state) for term in machine.torque), np.zeros((n, JOINTS)))
    signals = {"q_meas": state.q, "play": play, "torque": extra}

    rows = np.arange(n) if rows is None else np.asarray(rows)
    step = state.time[1] - state.time[0]
    found = {}
    for group in groups:
        late = machine.late.get(group, 0.0) / step
        place = np.clip(rows - late, 0, n - 1)
        found[group] = _MEASURE[group](machine, at(state, place), _at_dict(signals, place))
    return found


def predict(machine, state, groups):
    """Recording of a machine without concealed physics, its motors and the wrench as given: {group:
    (n, columns)}."""
    n = len(state.time)
    nothing = {"play": dict.fromkeys(("static", "dynamic"), np.zeros((n, JOINTS))),
               "torque": np.zeros((n, JOINTS))}
    return {group: _MEASURE[group](machine, state, nothing) for group in groups}


def _interpolate(values, place):
    """Values (n, ...) at fractional sample numbers: a cubic spline; the samples where all are whole."""
    whole = np.round(place).astype(int)
    if np.array_equal(whole, place):
        return values[whole]
    return CubicSpline(np.arange(len(values)), values)(place)


def _linear(values, place):
    first = np.floor(place).astype(int)
    part = (place - first).reshape((-1,) + (1,) * (values.ndim - 1))
    after = np.minimum(first + 1, len(values) - 1)
    return values[first] * (1 - part) + values[after] * part


def at(state, place):
    """The state at sample numbers `place` (fractions allowed), without its loads."""
    names = ("time", "q", "velocity", "acceleration", "wrench", "temperature")
    return State(**{name: _interpolate(getattr(state, name), place) for name in names})


def _at_dict(signals, place):
    return {"play": {kind: _linear(values, place) for kind, values in signals["play"].items()},
            "torque": _linear(signals["torque"], place)}


def _settle(machine, state, play):
    springs = elasticity.model_springs(machine.robot) + machine.springs
    return elasticity.settle(machine.robot, springs, state.q + machine.zero + play, state.wrench,
                             machine.balance)


def _measure_q(machine, state, signals):
    return state.q


def _measure_xyz(machine, state, signals):
    place, _ = _settle(machine, state, signals["play"]["static"])
    shift = sum((term(state, place.tool_rotation) for term in machine.shift), np.zeros((1, 3)))
    return place.tcp + shift


def _measure_q_link(machine, state, signals):
    """Link encoders: wind-up under everything, inertia included, and what lies in the transmission."""
    q = state.q + machine.zero
    torque = -_link_torque(machine.robot, state, q)
    if machine.balance:
        torque = torque + machine.balance(q)
    robot = machine.robot
    windup = robot.compliance * torque + robot.cubic * torque**3
    # One more round, in the bent posture.
    torque = -_link_torque(robot, state, q + windup)
    if machine.balance:
        torque = torque + machine.balance(q + windup)
    windup = robot.compliance * torque + robot.cubic * torque**3
    return q + windup + signals["play"]["dynamic"]


def _measure_tau(machine, state, signals):
    robot, q = machine.robot, state.q + machine.zero
    torque = _link_torque(robot, state, q) + robot.rotor * state.acceleration
    torque += robot.viscous * state.velocity + robot.coulomb * np.sign(state.velocity)
    if machine.balance:
        torque -= machine.balance(q)
    return torque + signals["torque"]


def _measure_wrench(machine, state, signals):
    """The sensor turns with the flange; its readings are given in the base frame as the model has it."""
    if not machine.sensor:
        return state.wrench
    rotation = posture(machine.robot, state.q).tool_rotation
    back = np.swapaxes(rotation, 1, 2)
    local = np.concatenate([turn(back, state.wrench[:, :3]), turn(back, state.wrench[:, 3:])], 1)
    for term in machine.sensor:
        local = term(local)
    return np.concatenate([turn(rotation, local[:, :3]), turn(rotation, local[:, 3:])], 1)


_MEASURE = {"q_meas": _measure_q, "q_link": _measure_q_link, "tau": _measure_tau,
            "wrench": _measure_wrench, "xyz": _measure_xyz}
