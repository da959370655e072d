"""Inverse-dynamics identification: what a textbook makes of torques, and what one makes who knows
the structure.

Angles and torques pass the same low-pass, forwards and backwards, for the fit; rows that stand or
creep are left out of it. Predictions are made from filtered angles and compared with torques as
recorded.
"""

import dataclasses

import numpy as np
from scipy.signal import butter, filtfilt

from . import arm

CREEPING = 0.02  # of a joint's largest speed
CUTOFFS = 3.0, 6.0, 12.0  # Hz
JUDGED_AT = 6.0  # Hz: the filter by which rows count as moving, whoever predicts
ROWS = 1500  # of a recording, evenly
LAST = 0.25  # of a recording, on which a choice is made
MASS_TOLERANCE = 0.3
ROUNDS = 10
SETTLED = 2e-3  # change of what is left, at which the rounds end


def smooth(values, rate, cutoff):
    """Without delay."""
    cutoff = min(cutoff, 0.4 * rate)
    return filtfilt(*butter(2, cutoff / (rate / 2)), values, axis=0)


@dataclasses.dataclass
class Motion:
    """A recording's angles as they were filtered (n, 6), and its torques as they are."""

    q: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    tau: np.ndarray
    rate: float
    cutoff: float

    @classmethod
    def of(cls, recording, cutoff):
        rate = 1 / np.median(np.diff(recording.time))
        q = smooth(recording.angles, rate, cutoff)
        velocity = np.gradient(q, 1 / rate, axis=0)
        return cls(q, velocity, np.gradient(velocity, 1 / rate, axis=0), recording.groups["tau"],
                   rate, cutoff)

    def rows(self, chosen):
        """Some of them."""
        return Motion(self.q[chosen], self.velocity[chosen], self.acceleration[chosen],
                      self.tau[chosen], self.rate, self.cutoff)

    def smoothed(self):
        return smooth(self.tau, self.rate, self.cutoff)


def moving(recording):
    """(n, 6) bool: faster than a share of the joint's largest speed, and not at the very ends."""
    speed = np.abs(Motion.of(recording, JUDGED_AT).velocity)
    return speed > CREEPING * speed.max(0)


def edges(velocity):
    """(n, 6) bool: moving."""
    speed = np.abs(velocity)
    return speed > CREEPING * speed.max(0)


@dataclasses.dataclass
class Structure:
    """What the model holds; drive columns are those of `_columns`."""

    bodies: bool = True
    both_ways: bool = False
    stribeck: bool = False
    load: bool = False
    gains: bool = False
    transmission: np.ndarray = dataclasses.field(default_factory=lambda: np.eye(6))


class Model:
    """Torques by numbers: ten of each link, then those of each drive, then the gains.

    All but Stribeck speeds and gains are linear."""

    def __init__(self, description, structure):
        self.structure, self.description = structure, description
        nominal = arm.lumped(description.chain)
        nominal[-1] += arm.point_mass(description.chain, description.payload_mass,
                                      description.payload_center)
        self.nominal = nominal.ravel()
        self._effort = description.column("effort")
        self._speed = description.column("speed")
        self.stribeck = 0.06 * self._speed
        self.gains = np.ones(6)
        self.load = None

    def body_tolerance(self):
        """(60,) how far a link's numbers may be off: by a share of what it and its size make."""
        found = []
        for mass, *_, in self.nominal.reshape(6, 10):
            found.append(mass)
        mass = np.array(found)
        tensor = self.nominal.reshape(6, 10)[:, [4, 7, 9]].max(1)
        first = np.sqrt(np.maximum(mass, 1e-9) * tensor)
        share = np.concatenate([mass[:, None], np.repeat(first[:, None], 3, 1),
                                np.repeat(tensor[:, None], 6, 1)], axis=1)
        # What hangs on the flange is anybody's guess.
        share[-1] += share[:-1].mean(0)
        return MASS_TOLERANCE * share.ravel()

    def drive_columns(self, motion, joint_load):
        """(n, 6 torques, columns) of all drives, and for the Stribeck speeds the derivatives."""
        turn = self.structure.transmission
        velocity, push = motion.velocity @ turn.T, motion.acceleration @ turn.T
        motor_load = np.abs(joint_load @ np.linalg.inv(turn)) / self._effort
        n = len(velocity)
        found = []
        for k in range(6):
            v, sign = velocity[:, k], np.sign(velocity[:, k])
            forward = v > 0
            if self.structure.both_ways:
                columns = [sign * forward, sign * ~forward, v * forward, v * ~forward]
            else:
                columns = [sign, v]
            columns.append(push[:, k])
            if self.structure.stribeck:
                columns.append(sign * np.exp(-(v / self.stribeck[k]) ** 2))
            if self.structure.load:
                columns.append(sign * motor_load[:, k])
            spread = np.zeros((n, 6, len(columns)))
            # A motor pushes on every joint that turns it.
            for joint in range(6):
                if turn[k, joint]:
                    spread[:, joint] = turn[k, joint] * np.stack(columns, -1)
            found.append(spread)
        return np.concatenate(found, axis=2)

    def body_columns(self, motion):
        """(n, 6, 60)."""
        return arm.regressor(self.description.chain, self.description.gravity, motion.q,
                             motion.velocity, motion.acceleration)

    def design(self, motion, bodies=None):
        """(n, 6, 60) of the bodies, which may be given, and (n, 6, columns) of the drives."""
        bodies = self.body_columns(motion) if bodies is None else bodies
        load = bodies @ (self.bodies if self.load is not None else self.nominal)
        return bodies, self.drive_columns(motion, load)

    def predict(self, motion, bodies=None):
        """(n, 6) N·m."""
        bodies, drives = self.design(motion, bodies)
        return self.gains * (bodies @ self.bodies + drives @ self.drives) + self.offsets


def _ridge(design, target, tolerance, expected, noise):
    """Least squares with numbers held to what is expected; infinite tolerance: free."""
    scale = np.where(np.isfinite(tolerance), tolerance, 1.0)
    held = np.isfinite(tolerance)
    weighted = design * scale / noise[:, None]
    left = (target - design @ expected) / noise
    normal = weighted.T @ weighted
    floor = 1e-10 * max(np.trace(normal) / len(normal), 1e-300)
    normal = normal + np.diag(np.where(held, 1.0, floor))
    return expected + scale * np.linalg.solve(normal, weighted.T @ left)


def fit(model, motion, *, hold=1.0):
    """Fits a Model to a Motion, whose rows are filtered and thinned. hold: how firmly bodies are held
    to the nominal ones; 0: not at all (base parameters)."""
    tau = motion.smoothed()
    end = max(2, int(motion.rate / motion.cutoff))  # the filter's ends are worth less
    rows = np.arange(end, len(tau) - end, max(1, len(tau) // ROWS))
    is_moving = edges(motion.velocity)[rows]
    some, tau = motion.rows(rows), tau[rows]
    structure = model.structure
    model.bodies, model.load, model.offsets = model.nominal.copy(), None, np.zeros(6)
    noise = np.maximum(tau.std(0), 1e-9) * 0.1
    body_tolerance = model.body_tolerance() / hold if hold else np.full(60, np.inf)
    rounds = ROUNDS if structure.gains or structure.stribeck or structure.load else 3
    bodies = model.body_columns(some)
    for _ in range(rounds):
        drives = model.design(some, bodies)[1]
        count = drives.shape[2]
        blocks, expected = [], []
        tolerance = []
        if structure.bodies:
            blocks.append(model.gains[:, None] * bodies)
            expected.append(model.nominal)
            tolerance.append(body_tolerance)
        blocks.append(model.gains[:, None] * drives)
        expected.append(np.zeros(count))
        tolerance.append(np.full(count, np.inf))
        blocks.append(np.broadcast_to(np.eye(6), (len(tau), 6, 6)))
        expected.append(np.zeros(6))
        tolerance.append(np.full(6, np.inf))
        target = tau
        if not structure.bodies:
            target = tau - bodies @ model.nominal
        if structure.gains and hasattr(model, "drives"):
            # Together with the rest, so that the two do not creep towards each other.
            raw = bodies @ model.bodies + drives @ model.drives
            blocks.append(raw[:, :, None] * np.eye(6))
            expected.append(1 - model.gains)
            tolerance.append(np.full(6, 0.15))
        if structure.stribeck and hasattr(model, "drives"):
            slopes = model.gains[:, None] * _stribeck_slopes(model, some, drives)
            blocks.append(slopes)
            expected.append(np.zeros(6))
            tolerance.append(0.5 * model.stribeck)
        design = np.concatenate(blocks, axis=2)
        weight = np.broadcast_to(noise, tau.shape)[is_moving]
        found = _ridge(design[is_moving], target[is_moving], np.concatenate(tolerance),
                       np.concatenate(expected), weight)
        if structure.bodies:
            model.bodies, found = found[:60], found[60:]
            model.load = True
        model.drives, found = found[:count], found[count:]
        model.offsets, found = found[:6], found[6:]
        if structure.gains and len(found) >= 6:
            model.gains, found = model.gains + found[:6], found[6:]
        if structure.stribeck and len(found) >= 6:
            low, high = 0.01 * model._speed, 0.3 * model._speed
            model.stribeck = np.clip(model.stribeck + found[:6], low, high)
        left = tau - model.predict(some, bodies)
        before, noise = noise, np.array([max(np.sqrt(np.mean(left[is_moving[:, k], k] ** 2)), 1e-9)
                                         for k in range(6)])
        if np.abs(noise / before - 1).max() < SETTLED:
            break
    return model


def _stribeck_slopes(model, motion, drives):
    """(n, 6, 6): change of torque by each Stribeck speed."""
    turn = model.structure.transmission
    velocity = motion.velocity @ turn.T
    each = drives.shape[2] // 6
    place = each - 1 - int(model.structure.load)
    found = np.zeros((len(velocity), 6, 6))
    for k in range(6):
        column = drives[:, :, k * each + place] * model.drives[k * each + place]
        change = 2 * velocity[:, k] ** 2 / model.stribeck[k] ** 3
        found[:, :, k] = column * change[:, None]
    return found


def _rms(model, motion, chosen):
    left = (motion.tau - model.predict(motion))[chosen]
    return float(np.sqrt(np.mean(left**2)))


def _parts(recording):
    """The recording cut in two by time, for choices: (first, last)."""
    count = len(recording.time)
    cut = int((1 - LAST) * count)

    def part(rows):
        return type(recording)(recording.time[rows], {name: values[rows] for name, values
                                                      in recording.groups.items()})

    return part(slice(0, cut)), part(slice(cut, None))


def best(candidates, recording, description):
    """The candidate, {name: (Structure, hold)}, and the filter that do best on a last part that they
    were not fitted to, then fitted to all. Returns (name, Model, cutoff)."""
    first, last = _parts(recording)
    chosen = moving(last)
    scores = {}
    for cutoff in CUTOFFS:
        training, judged = Motion.of(first, cutoff), Motion.of(last, cutoff)
        for name, (structure, hold) in candidates.items():
            model = fit(Model(description, structure), training, hold=hold)
            scores[name, cutoff] = _rms(model, judged, chosen)
    name, cutoff = min(scores, key=scores.get)
    structure, hold = candidates[name]
    return name, fit(Model(description, structure), Motion.of(recording, cutoff), hold=hold), cutoff


def plain(recording, description):
    """What a textbook fits: 24 numbers of drives, or base parameters with them."""
    return best({"drives": (Structure(bodies=False), 1.0), "base parameters": (Structure(), 0.0),
                 "base parameters, held": (Structure(), 1.0)}, recording, description)


def oracle(recording, description, truth):
    """The structure is known, the numbers are fitted."""
    has = truth["has"]
    structure = Structure(both_ways=True, stribeck=has["stribeck"], load=has["load"],
                          gains=has["gain"], transmission=np.array(truth["transmission"]))
    return best({"oracle": (structure, 1.0)}, recording, description)
