"""Physics that is in no catalogue. Each function conceals itself in the machine of one take."""

import numpy as np

from .effects.base import direction, log_uniform
from .kinematics import posture


def _course(time, values):
    return lambda state: np.interp(state.time, time, values)


def _shift(machine, course, vector):
    machine.shift.append(lambda state, rotation: np.outer(course(state), vector))


def _burst_course(rng, time, frequency):
    wave = np.zeros(len(time))
    for _ in range(rng.integers(2, 5)):
        length = rng.uniform(0.04, 0.12) * (time[-1] - time[0])
        begin = rng.uniform(time[0], time[-1] - length)
        share = np.clip((time - begin) / length, 0, 1)
        wave += np.sin(np.pi * share) ** 2 * np.sin(2 * np.pi * frequency * time + rng.uniform(0, 6))
    return wave


def chatter_burst(rng, machine, drive, robot, scale):
    """Bursts of vibration that no recorded load explains."""
    time = drive.track.time
    course = _course(time, _burst_course(rng, time, rng.uniform(0.2, 0.4) / drive.track.step))
    _shift(machine, course, log_uniform(rng, 2e-4, 8e-4) * direction(rng))


def torque_burst(rng, machine, drive, robot, scale):
    """Bursts of vibration in one motor's torque."""
    time, k = drive.track.time, rng.integers(6)
    course = _course(time, _burst_course(rng, time, rng.uniform(0.1, 0.3) / drive.track.step))
    size = rng.uniform(0.15, 0.5) * scale.torque[k] * np.eye(6)[k]
    machine.torque.append(lambda state: np.outer(course(state), size))


def tool_wear(rng, machine, drive, robot, scale):
    """The cutter shrinks as it cuts: the path moves inwards with the work done."""
    tcp = posture(robot, drive.track.q).tcp
    inward = tcp.mean(0) - tcp
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    work = np.cumsum(np.linalg.norm(drive.wrench[:, :3], axis=1))
    values = log_uniform(rng, 1.5e-4, 6e-4) * (work / work[-1])[:, None] * inward
    time = drive.track.time
    machine.shift.append(lambda state, rotation: np.column_stack(
        [np.interp(state.time, time, values[:, k]) for k in range(3)]))


def tracker_jump(rng, machine, drive, robot, scale):
    """Somebody bumps the tracker's tripod."""
    time = drive.track.time
    moment = time[0] + rng.uniform(0.25, 0.75) * (time[-1] - time[0])
    vector = log_uniform(rng, 1.5e-4, 8e-4) * direction(rng)
    machine.shift.append(lambda state, rotation: np.outer(state.time >= moment, vector))


def tracker_walk(rng, machine, drive, robot, scale):
    """The tracker's readings wander at random."""
    time = drive.track.time
    walk = np.cumsum(rng.normal(size=(len(time), 3)), 0)
    walk *= log_uniform(rng, 1e-4, 4e-4) / walk.std(0).max()
    machine.shift.append(lambda state, rotation: np.column_stack(
        [np.interp(state.time, time, walk[:, k]) for k in range(3)]))


def floor_vibration(rng, machine, drive, robot, scale):
    """A neighbouring machine shakes the floor, now more, now less."""
    time = drive.track.time
    beat = np.interp(time, np.linspace(time[0], time[-1], 9), rng.uniform(0, 1, 9))
    wave = beat * np.sin(2 * np.pi * rng.uniform(2.5, 12) * time + rng.uniform(0, 6))
    _shift(machine, _course(time, wave), log_uniform(rng, 1.5e-4, 5e-4) * direction(rng))


def joint_coupling(rng, machine, drive, robot, scale):
    """The motion of one joint turns another one along, through gears they share."""
    first, second = rng.choice(6, 2, replace=False)
    ratio, start = rng.choice([-1, 1]) * log_uniform(rng, 5e-4, 5e-3), drive.track.q[0, first]
    column = np.eye(6)[second]
    machine.transmission.append(lambda state: np.outer(ratio * (state.q[:, first] - start), column))


def tooth_defect(rng, machine, drive, robot, scale):
    """One damaged tooth: a bump of position error at one joint angle."""
    k = rng.integers(6)
    low, high = drive.track.q[:, k].min(), drive.track.q[:, k].max()
    place, width = rng.uniform(low, high), rng.uniform(0.02, 0.06) * max(high - low, 1e-3)
    size, column = log_uniform(rng, 1.5e-4, 8e-4), np.eye(6)[k]
    machine.transmission.append(lambda state: np.outer(
        size * np.exp(-(((state.q[:, k] - place) / width) ** 2)), column))


def load_dependent_encoder(rng, machine, drive, robot, scale):
    """The encoder's housing gives: an error with the size of the load, whatever its sign."""
    k = rng.integers(6)
    size = log_uniform(rng, 1.5e-4, 8e-4) / scale.load[k] * np.eye(6)[k]
    machine.memory.append(lambda state, load: np.abs(load[:, k])[:, None] * size)


def cable_harness(rng, machine, drive, robot, scale):
    """A cable harness pulls taut beyond some angle of a wrist joint."""
    k = rng.integers(3, 6)
    q = drive.track.q[:, k]
    begin, end = np.quantile(q, [rng.uniform(0.6, 0.8), 1.0])
    size = rng.uniform(0.3, 1.0) * scale.torque[k] * np.eye(6)[k]
    machine.torque.append(lambda state: np.outer(
        np.clip((state.q[:, k] - begin) / (end - begin), 0, None) ** 2, size))


def current_limit(rng, machine, drive, robot, scale):
    """The current sensor of one drive saturates."""
    k, share = rng.integers(6), rng.uniform(0.35, 0.65)
    limit, column = share * scale.torque[k], np.eye(6)[k]

    def missing(state):
        torque = -state.dynamic_load[:, k] + robot.viscous[k] * state.velocity[:, k]
        return np.outer(np.clip(torque, -limit, limit) - torque, column)

    machine.torque.append(missing)


def torque_walk(rng, machine, drive, robot, scale):
    """The zero of a current sensor wanders at random."""
    time, k = drive.track.time, rng.integers(6)
    walk = np.cumsum(rng.normal(size=len(time)))
    walk *= rng.uniform(0.08, 0.3) * scale.torque[k] / np.abs(walk).max()
    course, column = _course(time, walk), np.eye(6)[k]
    machine.torque.append(lambda state: np.outer(course(state), column))


POSITION_KINDS = ("circle", "air", "mixed")
FOREIGN = (
    (chatter_burst, POSITION_KINDS), (tool_wear, ("circle",)),
    (tracker_jump, POSITION_KINDS + ("static",)), (tracker_walk, POSITION_KINDS),
    (floor_vibration, POSITION_KINDS), (joint_coupling, POSITION_KINDS + ("link",)),
    (tooth_defect, POSITION_KINDS + ("link",)),
    (load_dependent_encoder, ("circle", "link", "mixed", "static")),
    (torque_burst, ("torque", "mixed")), (cable_harness, ("torque", "link")),
    (current_limit, ("torque",)), (torque_walk, ("torque",)),
)
