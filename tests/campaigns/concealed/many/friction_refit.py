"""Inverse-dynamics identification: what a textbook makes of torques, and what one makes who knows
the structure.

Angles and torques pass the same low-pass, forwards and backwards, for the fit; rows that stand or
creep are left out of it. Predictions are made from filtered angles and compared with torques as
recorded.
"""

import dataclasses

import numpy as np
from scipy.signal import butter, sosfiltfilt

from . import arm

CREEPING = 0.02  # of a joint's largest speed
CUTOFFS = 2.5, 3.5, 5.0, 7.0, 10.0  # Hz
ORDER = 4  # of the Butterworth filter, which passes twice
JUDGED_AT = 6.0  # Hz: the filter by which rows count as moving, whoever predicts
ROWS = 1500  # of a recording, evenly
LAST = 0.25  # of a recording, on which a choice is made
FIT_RATE = 125.0  # Hz
MASS_TOLERANCE, GAIN_TOLERANCE = 0.3, 0.15
ROUNDS, LINEAR_ROUNDS = 25, 2
GAIN_STEP = 0.1  # in a round
SETTLED = 3e-3  # change of what is left and of gains, at which the rounds end


def smooth(values, rate, cutoff):
    """Without delay."""
    cutoff = min(cutoff, 0.4 * rate)
    return sosfiltfilt(butter(ORDER, cutoff / (rate / 2), output="sos"), values, axis=0)


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

    def thinned(self, rate):
        """Rows at about a lower rate (Hz), the torques filtered as well."""
        every = max(1, round(self.rate / rate))
        tau = smooth(self.tau, self.rate, self.cutoff)
        return Motion(self.q[::every], self.velocity[::every], self.acceleration[::every],
                      tau[::every], self.rate / every, self.cutoff)


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
        self.stribeck_range = 0.01 * self._speed, 0.3 * self._speed
        self.gains, self.offsets = np.ones(6), np.zeros(6)
        self.bodies, self.drives = self.nominal.copy(), None

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
        """(n, 6, columns): what each motor's numbers do by its own motion.

        joint_load: (n, 6) N·m of the bodies."""
        turn, structure = self.structure.transmission, self.structure
        v, push = motion.velocity @ turn.T, motion.acceleration @ turn.T
        sign, forward = np.sign(v), v > 0
        columns = ([sign * forward, sign * ~forward, v * forward, v * ~forward]
                   if structure.both_ways else [sign, v])
        columns.append(push)
        if structure.stribeck:
            columns.append(sign * np.exp(-(v / self.stribeck) ** 2))
        if structure.load:
            motor_load = np.abs(joint_load @ np.linalg.inv(turn)) / self._effort
            columns.append(sign * motor_load)
        return np.stack(columns, -1)

    def stribeck_slopes(self, motion):
        """(n, 6): change of each motor's friction by its Stribeck speed."""
        v = motion.velocity @ self.structure.transmission.T
        column = np.sign(v) * np.exp(-(v / self.stribeck) ** 2) * 2 * v**2 / self.stribeck**3
        place = 5 if self.structure.both_ways else 3
        return column * self.drives[:, place]

    def on_joints(self, columns):
        """(n, 6 motors, c) -> (n, 6 joints, 6·c): a motor pushes on every joint that turns it."""
        turn = self.structure.transmission
        spread = turn.T[:, :, None] * columns[:, None]
        return spread.reshape(len(columns), 6, -1)

    def body_columns(self, motion):
        """(n, 6, 60)."""
        return arm.regressor(self.description.chain, self.description.gravity, motion.q,
                             motion.velocity, motion.acceleration)

    def predict(self, motion):
        """(n, 6) N·m."""
        bodies = self.body_columns(motion)
        drives = self.on_joints(self.drive_columns(motion, bodies @ self.bodies))
        return self.gains * (bodies @ self.bodies + drives @ self.drives.ravel()) + self.offsets


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


class _Fit:
    """The rows of a fit: every column has passed the filter that the torques have."""

    def __init__(self, model, motion):
        self.model, self._motion = model, motion.thinned(FIT_RATE)
        motion = self._motion
        end = max(2, int(motion.rate / motion.cutoff))  # the filter's ends are worth less
        count = len(motion.tau)
        self._rows = np.arange(end, count - end, max(1, count // ROWS))
        self._full_bodies = model.body_columns(motion)
        self.bodies = self._full_bodies[self._rows]
        self.moving = edges(motion.velocity)[self._rows]
        self.tau = motion.tau[self._rows]
        step = (self._rows[1] - self._rows[0]) / motion.rate
        self.repeated = np.sqrt(max(1.0, 1 / step / (2 * motion.cutoff)))

    def _filtered(self, columns):
        motion = self._motion
        return smooth(columns, motion.rate, motion.cutoff)[self._rows]

    def drives(self):
        load = self._full_bodies @ self.model.bodies
        return self.model.on_joints(self._filtered(self.model.drive_columns(self._motion, load)))

    def stribeck_slopes(self):
        return self.model.on_joints(self._filtered(self.model.stribeck_slopes(self._motion))[:, :, None])


def _blocks(model, rows, body_tolerance, is_last):
    """[(name, columns (n, 6, c), expected (c,), tolerance (c,)), …] of what is fitted in a round: in
    the first and the last only what is linear."""
    drives = rows.drives()
    n, count, free = len(drives), drives.shape[2], np.full
    blocks = []
    if model.structure.bodies:
        blocks.append(("bodies", model.gains[:, None] * rows.bodies, model.nominal, body_tolerance))
    blocks.append(("drives", model.gains[:, None] * drives, np.zeros(count), free(count, np.inf)))
    blocks.append(("offsets", np.broadcast_to(np.eye(6), (n, 6, 6)), np.zeros(6), free(6, np.inf)))
    if model.drives is None or is_last:
        return blocks
    if model.structure.gains:
        # Together with the rest, so that the two do not creep towards each other.
        raw = rows.bodies @ model.bodies + drives @ model.drives.ravel()
        blocks.append(("gains", raw[:, :, None] * np.eye(6), 1 - model.gains,
                       free(6, GAIN_TOLERANCE)))
    if model.structure.stribeck:
        blocks.append(("stribeck", model.gains[:, None] * rows.stribeck_slopes(), np.zeros(6),
                       0.5 * model.stribeck))
    return blocks


def _take(model, found):
    """The numbers of a round, {block: values}, into the model."""
    model.bodies = found.get("bodies", model.bodies)
    model.drives = found["drives"].reshape(6, -1)
    model.offsets = found["offsets"]
    if "gains" in found:
        model.gains = model.gains + np.clip(found["gains"], -GAIN_STEP, GAIN_STEP)
    if "stribeck" in found:
        model.stribeck = np.clip(model.stribeck + found["stribeck"], *model.stribeck_range)


def fit(model, motion, *, hold=1.0):
    """Fits a Model to a Motion. hold: how firmly bodies are held to the nominal ones; 0: not at all
    (base parameters)."""
    rows = _Fit(model, motion)
    noise = 0.1 * np.maximum(rows.tau.std(0), 1e-9)
    body_tolerance = model.body_tolerance() / hold if hold else np.full(60, np.inf)
    is_nonlinear = model.structure.gains or model.structure.stribeck or model.structure.load
    for number in range(ROUNDS if is_nonlinear else LINEAR_ROUNDS):
        before, gains = noise, model.gains
        noise = _round(model, rows, body_tolerance, noise, False)
        is_quiet = np.abs(noise / before - 1).max() < SETTLED
        if number > 2 and is_quiet and np.abs(model.gains - gains).max() < SETTLED:
            break
    _round(model, rows, body_tolerance, noise, True)
    return model


def _round(model, rows, body_tolerance, noise, is_last):
    """Fits once, given each torque's noise (6,); returns what noise is left."""
    tau, is_moving = rows.tau, rows.moving
    blocks = _blocks(model, rows, body_tolerance, is_last)
    target = tau if model.structure.bodies else tau - rows.bodies @ model.nominal
    design = np.concatenate([block[1] for block in blocks], axis=2)
    # Filtered rows are not independent of one another.
    weight = np.broadcast_to(noise * rows.repeated, tau.shape)[is_moving]
    numbers = _ridge(design[is_moving], target[is_moving],
                     np.concatenate([block[3] for block in blocks]),
                     np.concatenate([block[2] for block in blocks]), weight)
    ends = np.cumsum([block[1].shape[2] for block in blocks])[:-1]
    left = target - design @ numbers
    _take(model, dict(zip((block[0] for block in blocks), np.split(numbers, ends))))
    return np.array([max(np.sqrt(np.mean(left[is_moving[:, k], k] ** 2)), 1e-9) for k in range(6)])


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
