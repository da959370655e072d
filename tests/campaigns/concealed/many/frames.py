"""Every link frame a little off, seen by a tracker: static poses or one continuous motion."""

import copy
import dataclasses

import mujoco
import numpy as np
from plant import assembly, description as descriptions, recording
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from . import motions, robots

EARTH = 9.81  # m/s²
SETTLING = 4  # rounds until springs and weights agree
ENCODER = 1e-6  # rad, steps at the joint
RATE = 50.0  # Hz of a motion
QUIET = 0.5  # of the noise: what the springs may give way to inertia, which is left to the remainder
SLOWEST, FASTEST = 0.04, 0.15  # Hz, of a motion's waves
RAMP = 8.0  # s from rest to its pace


def _log_uniform(rng, low, high, size=None):
    return np.exp(rng.uniform(np.log(low), np.log(high), size))


@dataclasses.dataclass
class Truth:
    """What is concealed."""

    description: object  # plant.description.Description with every frame, zero and spring as it is
    zeros: np.ndarray  # (6,) rad, added to the encoders' angles
    base_offset: np.ndarray  # (3,) m and
    base_turn: np.ndarray  # (3,) rad: the robot's base in the tracker's frame
    base_compliance: np.ndarray  # (6,) m/N, rad/(N·m)
    late: float  # s, the tracker's clock
    noise: float  # m, each axis
    ripple: list  # of (joint, amplitude rad, order, phase)
    drift: np.ndarray  # (3,) m, in the end
    warm: float  # share of the recording in which most of the drift comes


def _shift(rng, joint, length, angle):
    joint.position = joint.position + length * rng.normal(size=3)
    turn = Rotation.from_rotvec(angle * rng.normal(size=3)).as_matrix()
    joint.rotation = joint.rotation @ turn


def _base(rng):
    """How far the tracker's frame is from the robot's: (m, rad)."""
    kind = rng.choice(["exact", "near", "elsewhere"], p=[0.3, 0.3, 0.4])
    length, angle = {"exact": (0, 0), "near": (1e-3, 1e-3),
                     "elsewhere": (rng.uniform(0.01, 0.2), np.radians(rng.uniform(0.5, 8)))}[kind]
    return length * rng.normal(size=3), angle * rng.normal(size=3), str(kind)


def _moment_at_base(description, region):
    """Typical change of the weight's moment about the base (N·m)."""
    body = _Body(description)
    moments = [body.base_load(q, np.zeros(6))[3:] for q in region.draw(np.random.default_rng(0), 40)]
    return float(np.linalg.norm(np.std(moments, axis=0))) + 1e-9


class _Body:
    """The rigid robot in the engine."""

    def __init__(self, description):
        self._model = assembly.rigid(description)
        self._data = mujoco.MjData(self._model)
        self._site = self._model.site("tcp").id
        self._gravity = np.array(description.gravity)

    def load(self, q, velocity, acceleration, wrench):
        """Torques (6,) that weight, motion and wrench (base frame) exert on the joints."""
        data = self._data
        data.qpos[:], data.qvel[:], data.qacc[:] = q, velocity, acceleration
        mujoco.mj_inverse(self._model, data)
        torque = -data.qfrc_inverse.copy()
        if wrench.any():
            linear, angular = np.zeros((3, 6)), np.zeros((3, 6))
            mujoco.mj_jacSite(self._model, data, linear, angular, self._site)
            torque += linear.T @ wrench[:3] + angular.T @ wrench[3:]
        return torque

    def place(self, q):
        """(3,) m, the TCP."""
        self._data.qpos[:] = q
        mujoco.mj_kinematics(self._model, self._data)
        return self._data.site_xpos[self._site].copy()

    def base_load(self, q, wrench):
        """Force and moment (6,) on the base, at its origin."""
        self._data.qpos[:] = q
        mujoco.mj_kinematics(self._model, self._data)
        mujoco.mj_comPos(self._model, self._data)
        mass, center = self._model.body_subtreemass[0], self._data.subtree_com[0]
        weight = mass * self._gravity
        force = weight + wrench[:3]
        tip = self._data.site_xpos[self._site]
        return np.concatenate([force, np.cross(center, weight) + np.cross(tip, wrench[:3])
                               + wrench[3:]])


def positions(truth, q, velocity, acceleration, wrench):
    """(n, 3) m, where the TCP is in the tracker's frame; all else (n, 6)."""
    body = _Body(truth.description)
    springs = truth.description.column("compliance")
    frame = Rotation.from_rotvec(truth.base_turn).as_matrix()
    found = np.empty((len(q), 3))
    for row, angles in enumerate(q + truth.zeros):
        for joint, amplitude, order, phase in truth.ripple:
            angles[joint - 1] += amplitude * np.sin(order * q[row, joint - 1] + phase)
        bent = angles
        for _ in range(SETTLING):
            bent = angles + springs * body.load(bent, velocity[row], acceleration[row], wrench[row])
        point = body.place(bent)
        if truth.base_compliance.any():
            give = truth.base_compliance * body.base_load(bent, wrench[row])
            point = Rotation.from_rotvec(give[3:]).apply(point) + give[:3]
        found[row] = frame @ point + truth.base_offset
    return found


def _conceal(rng, nominal, region, is_motion):
    actual = copy.deepcopy(nominal)
    length, angle = _log_uniform(rng, 1e-4, 1e-3), _log_uniform(rng, 1e-4, 2e-3)
    for joint in actual.chain[:-1]:
        _shift(rng, joint, length, angle)
    actual.chain[-1].position = actual.chain[-1].position + _log_uniform(rng, 2e-4, 5e-3) * \
        rng.normal(size=3)
    for joint in actual.joints:
        joint.compliance *= float(_log_uniform(rng, 0.6, 1.8))
    offset, turn, kind = _base(rng)
    reach = float(np.linalg.norm(_Body(nominal).place(region.center)))
    give = np.zeros(6)
    if rng.random() < 0.35:
        sway = _log_uniform(rng, 5e-5, 4e-4) / reach / _moment_at_base(nominal, region)
        give[3:5] = sway * rng.uniform(0.5, 1.5, 2)
        give[5] = 0.3 * sway
        give[:3] = sway * reach**2 * rng.uniform(0, 0.5, 3)
    noise = float(_log_uniform(rng, 12e-6 if is_motion else 4e-6, 40e-6))
    remainder = noise * rng.uniform(0.3, 1.2)
    ripple = [(int(joint), float(remainder * rng.uniform(0.4, 1) / reach), int(rng.integers(20, 160)),
               float(rng.uniform(0, 6.28))) for joint in rng.choice([1, 2, 3, 4], 2, replace=False)]
    drift = rng.normal(size=3)
    drift *= rng.uniform(10e-6, 40e-6) / np.linalg.norm(drift)
    return Truth(actual, angle * rng.normal(size=6), offset, turn, give,
                 float(rng.uniform(1e-3, 20e-3)) if is_motion else 0.0, noise, ripple, drift,
                 float(rng.uniform(0.2, 0.8))), {"base": kind, "length": float(length),
                                                 "angle": float(angle)}


def _wrenches(rng, count, rated):
    """Weights hung on the tool, and pulls to the side, in half of the poses (n, 6)."""
    wrench = np.zeros((count, 6))
    for row in np.flatnonzero(rng.random(count) < 0.5):
        force = rated * EARTH * rng.uniform(0.2, 0.8)
        wrench[row, :3] = force * np.array([0, 0, -1.0]) if rng.random() < 0.6 else \
            force * 0.5 * rng.normal(size=3)
    return wrench


def _shown(rng, truth, place, begin):
    """With noise and the drift, of which a share is there from the beginning."""
    n = len(place)
    warmth = 1 - np.exp(-(np.arange(n) / n + begin) / truth.warm)
    return place + warmth[:, None] * truth.drift + truth.noise * rng.normal(size=place.shape)


def _record_poses(rng, truth, region, count, rated, path, begin):
    q = np.round(region.draw(rng, count) / ENCODER) * ENCODER
    wrench = _wrenches(rng, count, rated) if rated else np.zeros((count, 6))
    still = np.zeros((count, 6))
    place = positions(truth, q, still, still, wrench)
    groups = {"q_meas": q, "xyz": _shown(rng, truth, place, begin)}
    if rated:
        groups["wrench"] = wrench
    recording.write(path, np.arange(count, dtype=float), groups)


def _calm_motion(rng, truth, region, duration):
    """A motion slow enough for the arm's springs."""
    state, top = rng.bit_generator.state, FASTEST
    while True:
        rng.bit_generator.state = state
        course = motions.swing(rng, truth.description, region, duration, 1 / RATE, top=top, share=0.3,
                               within=RAMP)
        some = slice(None, None, 40)
        still = np.zeros_like(course.q[some])
        moving = positions(truth, course.q[some], course.velocity[some], course.acceleration[some],
                           still)
        gives = moving - positions(truth, course.q[some], still, still, still)
        share = np.sqrt(np.mean(gives**2)) / truth.noise
        if share < QUIET or top < SLOWEST:
            return course
        top *= max(0.5, 0.95 * np.sqrt(QUIET / share))


def _record_motion(rng, truth, course, path, begin):
    """The tracker's rows show where the tool was `late` before."""
    place = positions(truth, course.q, course.velocity, course.acceleration,
                      np.zeros_like(course.q))
    seen = CubicSpline(course.time, place)(np.maximum(course.time - truth.late, 0))
    q = np.round(course.q / ENCODER) * ENCODER
    recording.write(path, course.time, {"q_meas": q, "xyz": _shown(rng, truth, seen, begin)})


def write_case(seed, number, folder):
    """Writes the nominal model and three recordings; returns the truth."""
    rng = np.random.default_rng([seed, 1, number])
    names = robots.available()
    name = names[number % len(names)]
    rated = robots.SOURCES[name].rated
    reach = 0.1 if rated < 20 else 0.25
    tool = np.array([rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), rng.uniform(0.6, 1.2)]) * reach
    payload = {"mass": round(rated * float(rng.uniform(0.1, 0.4)), 2), "com": [0.0, 0.0, 0.0]}
    robots.write_model(name, folder, tool, payload=payload)
    nominal = descriptions.load(folder / "robot.yaml")
    region, elsewhere = motions.regions(rng, nominal)
    is_motion = (number // len(names) + number) % 2 == 1
    truth, drawn = _conceal(rng, nominal, region, is_motion)
    loaded = not is_motion and rng.random() < 0.35
    sizes = {"train": int(_log_uniform(rng, 60, 1000)), "holdout": 150, "untrained": 100}
    for begin, (part, count) in zip((0, 0.3, 0.6), sizes.items()):
        where = elsewhere if part == "untrained" else region
        path = folder / f"{part}.csv"
        if is_motion:
            duration = rng.uniform(120, 200) if part == "train" else 60
            _record_motion(rng, truth, _calm_motion(rng, truth, where, duration), path, begin)
        else:
            _record_poses(rng, truth, where, count, rated if loaded else 0, path, begin)
    return {"class": "frames", "robot": name, "kind": "motion" if is_motion else "poses",
            "loaded": bool(loaded), "noise": truth.noise, "late": truth.late,
            "has_base_compliance": bool(truth.base_compliance.any()),
            "base_compliance": truth.base_compliance.tolist(),
            "compliance": truth.description.column("compliance").tolist(),
            "base_offset": truth.base_offset.tolist(), "base_turn": truth.base_turn.tolist(),
            "drift": truth.drift.tolist(), "ripple": truth.ripple, **drawn}
