"""Friction on every axis, masses a fifth off, coarse encoders: torques along a smooth motion."""

import copy
import dataclasses

import mujoco
import numpy as np
from plant import assembly, description as descriptions, recording

from . import motions, robots

FINE = 1000.0  # Hz, at which the motion is carried out
RATES = (100, 100, 100, 125, 250, 500, 1000)  # Hz, of the log
MASS_OFF = 0.2
SMALLEST = 0.3  # of a nominal body, in mass
PARTS = 0.8  # s in which the pace changes


@dataclasses.dataclass
class Drive:
    """One axis' motor, joint side; each pair for turning forwards and backwards."""

    dry: tuple  # N·m
    viscous: tuple  # N·m·s/rad
    stick: float  # of the dry friction, more at rest
    stribeck: float  # rad/s
    by_load: float  # share that dry friction grows by at the motor's rated torque
    presliding: float  # rad
    rotor: float  # kg·m²
    offset: float  # N·m
    gain: float  # shown torque over true
    cogging: tuple  # N·m, order, phase


@dataclasses.dataclass
class Truth:
    description: object
    drives: list
    transmission: np.ndarray  # (6, 6) motor speeds by joint speeds
    warming: float  # share of friction lost when warm
    warm: float  # s
    steps: np.ndarray  # (6,) rad of the encoders
    noise: np.ndarray  # (6,) N·m
    rate: int  # Hz


def _body_off(rng, body):
    """A body of other mass, center and inertia, which there can be: its mass density, mapped
    linearly (Wensing, Kim and Slotine 2018)."""
    spread = 0.5 * np.trace(body.inertia) * np.eye(3) - body.inertia
    size = np.sqrt(max(np.trace(spread), 1e-9) / body.mass)
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = spread + body.mass * np.outer(body.center, body.center)
    matrix[:3, 3] = matrix[3, :3] = body.mass * body.center
    matrix[3, 3] = body.mass
    change = np.eye(4)
    change[:3, :3] += 0.5 * MASS_OFF * rng.normal(size=(3, 3))
    change[:3, 3] = 0.5 * MASS_OFF * max(size, np.linalg.norm(body.center)) * rng.normal(size=3)
    factor = max(1 + MASS_OFF * rng.normal(), SMALLEST)
    matrix = factor * change @ matrix @ change.T
    mass, center = matrix[3, 3], matrix[:3, 3] / matrix[3, 3]
    spread = matrix[:3, :3] - mass * np.outer(center, center)
    body.mass, body.center, body.inertia = mass, center, np.trace(spread) * np.eye(3) - spread


def _rigid_torques(description, course):
    """(n, 6) N·m of inverse dynamics."""
    model = assembly.rigid(description)
    data = mujoco.MjData(model)
    found = np.empty_like(course.q)
    for row in range(len(course.q)):
        data.qpos[:] = course.q[row]
        data.qvel[:] = course.velocity[row]
        data.qacc[:] = course.acceleration[row]
        mujoco.mj_inverse(model, data)
        found[row] = data.qfrc_inverse
    return found


def presliding(angle, length):
    """(n,) in -1 to 1: where the bristles of dry friction are, after Dahl."""
    state, found = 0.0, np.zeros(len(angle))
    change = np.diff(angle)
    keep = np.exp(-np.abs(change) / length)
    sign = np.sign(change)
    for row in range(len(change)):
        state = sign[row] + (state - sign[row]) * keep[row]
        found[row + 1] = state
    return found


def friction(drive, angle, velocity, load):
    """(n,) N·m that a motor overcomes; load: (n,) torque over the rated one."""
    bristles = presliding(angle, drive.presliding)
    dry = np.where(bristles > 0, *drive.dry) * (1 + drive.by_load * np.abs(load))
    dry = dry * (1 + drive.stick * np.exp(-(velocity / drive.stribeck) ** 2))
    return dry * bristles + np.where(velocity > 0, *drive.viscous) * velocity


def torques(truth, course, warmth):
    """(n, 6) N·m as the drives show them, on the joints' side, without noise."""
    rigid = _rigid_torques(truth.description, course)
    turn = truth.transmission
    angle, velocity = course.q @ turn.T, course.velocity @ turn.T
    push = course.acceleration @ turn.T
    motor_load = rigid @ np.linalg.inv(turn) / truth.description.column("effort")
    cooling = 1 - truth.warming * (1 - np.exp(-course.time / truth.warm)) * warmth
    motor = np.empty_like(rigid)
    for k, drive in enumerate(truth.drives):
        height, order, phase = drive.cogging
        motor[:, k] = (cooling * friction(drive, angle[:, k], velocity[:, k], motor_load[:, k])
                       + drive.rotor * push[:, k] + height * np.sin(order * angle[:, k] + phase))
    shown = rigid + motor @ turn
    return np.array([drive.gain for drive in truth.drives]) * shown + [
        drive.offset for drive in truth.drives]


def _both_ways(rng, size, apart):
    return tuple(float(size * (1 + sign * apart * rng.uniform(-1, 1))) for sign in (1, -1))


def _drive(rng, effort, speed, with_):
    """with_: which effects the case has."""
    dry = effort * float(np.exp(rng.uniform(np.log(0.006), np.log(0.03))))
    return Drive(
        dry=_both_ways(rng, dry, 0.25),
        viscous=_both_ways(rng, dry / speed * rng.uniform(0.4, 2.5), 0.25),
        stick=float(rng.uniform(0.1, 0.5)) if with_["stribeck"] else 0.0,
        stribeck=float(speed * rng.uniform(0.03, 0.12)),
        by_load=float(rng.uniform(0.5, 2.0)) if with_["load"] and rng.random() < 0.6 else 0.0,
        presliding=float(rng.uniform(2e-5, 3e-4)),
        rotor=float(effort / speed * rng.uniform(0.006, 0.03)),
        offset=float(dry * rng.normal() * 0.2),
        gain=float(1 + rng.choice([-1, 1]) * rng.uniform(0.05, 0.2)) if with_["gain"] else 1.0,
        cogging=(float(dry * rng.uniform(0.01, 0.06)), int(rng.integers(8, 60)),
                 float(rng.uniform(0, 6.28))))


def _motion(rng, description, region, rate, faster=1.0):
    """Smooth, with a stop and a creeping stretch, slow enough for the drives."""
    duration = rng.uniform(30, 60) if rate <= 125 else rng.uniform(12, 25)
    creep = duration * rng.uniform(0.15, 0.4)
    stop = duration * rng.uniform(0.55, 0.8)
    rests = ((creep, creep + rng.uniform(1.5, 3), rng.uniform(0.005, 0.04)),
             (stop, stop + 1.5, 0.0))
    state, top, share = rng.bit_generator.state, faster * rng.uniform(0.3, 0.7), rng.uniform(0.4, 0.7)
    while True:
        rng.bit_generator.state = state
        course = motions.swing(rng, description, region, duration, 1 / FINE, top=top,
                               share=min(share * faster, 0.9), within=PARTS, rests=rests)
        few = motions.Course(*(part[::50] for part in dataclasses.astuple(course)))
        most = np.abs(_rigid_torques(description, few)).max(0) / description.column("effort")
        if (most < 0.9).all() or top < 0.1:
            return course
        top, share = 0.85 * top, 0.85 * share


def _record(rng, truth, course, warmth, path):
    shown = torques(truth, course, warmth)
    stride = round(FINE / truth.rate)
    rows = slice(0, None, stride)
    shown = shown[rows] + truth.noise * rng.normal(size=shown[rows].shape)
    q = np.round(course.q[rows] / truth.steps) * truth.steps
    recording.write(path, course.time[rows], {"q_meas": q, "tau": shown})


def _transmission(rng, coupled):
    matrix = np.eye(6)
    if coupled:
        matrix[5, 4] = rng.choice([1.0, -1.0, float(rng.uniform(0.3, 0.8))], p=[0.5, 0.25, 0.25])
    return matrix


def _nominal(rng, name, folder):
    """Writes it, without friction and rotors; returns its Description."""
    rated = robots.SOURCES[name].rated
    reach = 0.1 if rated < 20 else 0.25
    tool = np.array([0.0, 0.0, rng.uniform(0.3, 1.0)]) * reach
    robots.write_model(name, folder, tool)
    return descriptions.load(folder / "robot.yaml")


def write_case(seed, number, folder):
    """Writes the nominal model and three recordings; returns the truth."""
    rng = np.random.default_rng([seed, 2, number])
    names = robots.available()
    name = names[number % len(names)]
    nominal = _nominal(rng, name, folder)
    region, elsewhere = motions.regions(rng, nominal)
    with_ = {"stribeck": rng.random() < 0.6, "load": rng.random() < 0.35,
             "gain": rng.random() < 0.4, "payload": rng.random() < 0.4,
             "coupled": rng.random() < 0.3}
    actual = copy.deepcopy(nominal)
    for joint in actual.chain:
        if joint.body is not None:
            _body_off(rng, joint.body)
    if with_["payload"]:
        actual.payload_mass = robots.SOURCES[name].rated * float(rng.uniform(0.2, 0.7))
        actual.payload_center = 0.05 * rng.normal(size=3)
    effort, speed = actual.column("effort"), actual.column("speed")
    drives = [_drive(rng, effort[k], speed[k], with_) for k in range(6)]
    rate = int(rng.choice(RATES))
    step = float(np.exp(rng.uniform(np.log(1e-4), np.log(1e-3))))
    truth = Truth(actual, drives, _transmission(rng, with_["coupled"]), float(rng.uniform(0, 0.06)),
                  float(rng.uniform(20, 200)), np.full(6, step), np.zeros(6), rate)
    courses = {"train": _motion(rng, actual, region, rate), "holdout": _motion(rng, actual, region, rate),
               "untrained": _motion(rng, actual, elsewhere, rate, float(rng.choice([0.5, 1.3])))}
    size = torques(truth, courses["train"], 1).std(0)
    truth.noise = size * np.exp(rng.uniform(np.log(0.005), np.log(0.03), 6))
    for begin, (part, course) in enumerate(courses.items()):
        _record(rng, truth, course, 1.0 if begin else 0.7, folder / f"{part}.csv")
    return {"class": "friction", "robot": name, "rate": rate, "step": step,
            "duration": float(courses["train"].time[-1]),
            "has": {key: bool(value) for key, value in with_.items()},
            "noise": truth.noise.tolist(), "transmission": truth.transmission.tolist(),
            "payload": {"mass": actual.payload_mass, "com": np.asarray(actual.payload_center).tolist()},
            "masses": [[float(before.body.mass), float(after.body.mass)]
                       for before, after in zip(nominal.chain, actual.chain) if before.body],
            "warming": truth.warming, "warm": truth.warm, "drives": [dataclasses.asdict(drive) for drive in drives]}
