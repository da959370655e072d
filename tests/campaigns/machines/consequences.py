"""What an effect adds to the channel that a recording measures, exactly.

An effect here is a class with the name and the joint that a diagnosis should give. Its `trace` says by
how much each measured column changes, by an amount of the effect; what an amount is, its class says.
Nothing of this knows how flexcomp computes.
"""

import dataclasses

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import savgol_filter

from .tables import columns_of

SMOOTHINGS = 0.08, 0.16, 0.3  # s of the polynomials that tell speeds and accelerations
STEPS = 6.0  # Hz, above which an acceleration is mostly the encoders' steps
MOST_STEPS = 0.1  # of an acceleration's power
SLOW = 0.01  # of a joint's largest speed, over which dry friction turns round
FASTEST = 4.0  # Hz, of a ripple: a motion's angles tell no faster torque
SPANS = 4, 10  # periods of a ripple in a joint's travel
MOVES = 0.05  # rad or m, from which a joint counts as moving


def stacked(recording, group):
    """(n, columns) of a group of a recording's columns."""
    return np.column_stack([recording[name] for name in columns_of(recording, group)])


def angles_of(recording):
    """(n, joints): measured, else commanded."""
    measured = columns_of(recording, "q_meas")
    return stacked(recording, "q_meas" if measured else "q_cmd")


def _derived(time, values, order, smoothing):
    """(n, columns): local cubics (Savitzky and Golay, 1964) on the grid of the median step."""
    step = float(np.median(np.diff(time)))
    window = max(7, 2 * round(smoothing / step / 2) + 1)
    return savgol_filter(values, window, 3, deriv=order, delta=step, axis=0)


def _smoothing(recording):
    """s: the shortest that leaves of every joint's acceleration little but motion."""
    time, q = recording["t"], angles_of(recording)
    frequency = np.fft.rfftfreq(len(time), float(np.median(np.diff(time))))
    for smoothing in SMOOTHINGS:
        power = np.abs(np.fft.rfft(_derived(time, q, 2, smoothing), axis=0)) ** 2
        if (power[frequency > STEPS].sum(0) <= MOST_STEPS * power.sum(0)).all():
            break
    return smoothing


def _derivative(recording, order):
    """(n, joints) of the angles."""
    return _derived(recording["t"], angles_of(recording), order, _smoothing(recording))


@dataclasses.dataclass
class Effect:
    """name, joint: as in diagnosis.json. numbers: drawn ones that the trace needs. same: further
    (name, joint) that say the same of the same recording."""

    joint: int | None
    numbers: dict
    arm: object

    name = ""
    group = ""
    most = np.inf  # plausible amount

    @property
    def same(self):
        return []

    @classmethod
    def draw(cls, rng, joint, recording, arm):
        return cls(joint, {}, arm)

    def most_in(self, recording):
        """The largest amount that a machine which was recorded so may have."""
        return self.most

    def trace(self, recording, amount):
        """{column: (n,)}"""
        raise NotImplementedError

    def matches(self, finding):
        """Whether a finding names it."""
        return (finding.effect, finding.joint) in [(self.name, self.joint), *self.same]

    def __str__(self):
        return self.name + (f" {self.joint}" if self.joint else "")


class _DriveTorque(Effect):
    """At one joint: amount times a shape."""

    group = "tau"

    def shape(self, recording):
        raise NotImplementedError

    def trace(self, recording, amount):
        return {f"tau_{self.joint}": amount * self.shape(recording)}


class ViscousFriction(_DriveTorque):
    """amount: N·m·s/rad."""

    name = "viscous_friction"

    def shape(self, recording):
        return _derivative(recording, 1)[:, self.joint - 1]


class DryFriction(_DriveTorque):
    """amount: N·m."""

    name = "coulomb_friction"

    @property
    def same(self):
        return [("friction_hysteresis", self.joint)]

    def shape(self, recording):
        speed = _derivative(recording, 1)[:, self.joint - 1]
        return np.tanh(speed / (SLOW * np.abs(speed).max()))


class TorqueOffset(_DriveTorque):
    """amount: N·m."""

    name = "torque_offset"

    def shape(self, recording):
        return np.ones(len(recording["t"]))


class TorqueGain(_DriveTorque):
    """amount: share by which the drive shows too much."""

    name = "torque_gain"
    most = 0.5

    def shape(self, recording):
        return recording[f"tau_{self.joint}"]


class RotorInertia(_DriveTorque):
    """amount: kg·m²."""

    name = "rotor_inertia"

    def most_in(self, recording):
        """The drive has turned it: it took no more than the largest torque that was measured."""
        return np.abs(recording[f"tau_{self.joint}"]).max() / np.abs(self.shape(recording)).max()

    def shape(self, recording):
        return _derivative(recording, 2)[:, self.joint - 1]


def _wave(rng, joint, recording):
    """Order and phase of a ripple."""
    q = angles_of(recording)[:, joint - 1]
    order = 2 * np.pi * rng.uniform(*SPANS) / np.ptp(q)
    if columns_of(recording, "q_meas"):
        speed = np.abs(_derivative(recording, 1)[:, joint - 1]).max()
        order = min(order, 2 * np.pi * FASTEST / speed)
    return {"order": float(np.round(order)) or 1.0, "phase": float(rng.uniform(-np.pi, np.pi))}


class TorqueRipple(_DriveTorque):
    """amount: N·m."""

    name = "torque_ripple"

    @classmethod
    def draw(cls, rng, joint, recording, arm):
        return cls(joint, _wave(rng, joint, recording), arm)

    def shape(self, recording):
        angle = angles_of(recording)[:, self.joint - 1]
        return np.sin(self.numbers["order"] * angle + self.numbers["phase"])


class Payload(Effect):
    """amount: kg, a point at the tool."""

    name, group = "payload", "tau"

    @property
    def same(self):
        return [("link_mass", self.arm.joints)]

    def trace(self, recording, amount):
        stand = self.arm.stand(angles_of(recording))
        push = _derived(recording["t"], stand.tip, 2, _smoothing(recording)) - self.arm.gravity
        found = {}
        for k, (axis, origin, slides) in enumerate(zip(stand.axes, stand.origins,
                                                       self.arm.slides)):
            lever = axis if slides else np.cross(axis, stand.tip - origin)
            found[f"tau_{k + 1}"] = amount * (lever * push).sum(1)
        return found


class LateTorques(Effect):
    """amount: s by which all torques come late."""

    name, group = "time_offset", "tau"
    most = 0.1

    def trace(self, recording, amount):
        time, found = recording["t"], {}
        for column in columns_of(recording, "tau"):
            values = recording[column]
            found[column] = CubicSpline(time, values)(np.maximum(time - amount, time[0])) - values
        return found


class LinkRipple(Effect):
    """amount: rad, of a gear's transmission, seen by a link-side encoder."""

    name, group = "transmission_ripple", "q_link"
    most = 5e-3

    @classmethod
    def draw(cls, rng, joint, recording, arm):
        return cls(joint, _wave(rng, joint, recording), arm)

    def trace(self, recording, amount):
        angle = recording[f"q_meas_{self.joint}"]
        wave = np.sin(self.numbers["order"] * angle + self.numbers["phase"])
        return {f"q_link_{self.joint}": amount * wave}


class LinkZero(Effect):
    """amount: rad that the link stands off its motor's encoder."""

    name, group = "joint_offset", "q_link"
    most = 0.05

    def trace(self, recording, amount):
        return {f"q_link_{self.joint}": np.full(len(recording["t"]), amount)}


class _Position(Effect):
    group = "xyz"

    def shift(self, q, amount):
        """(n, 3) m"""
        raise NotImplementedError

    def trace(self, recording, amount):
        return dict(zip("xyz", self.shift(angles_of(recording), amount).T))


class JointZero(_Position):
    """amount: rad by which a joint stands further than its encoder says."""

    name = "joint_offset"
    most = 0.05

    @property
    def same(self):
        # About the first axis, the whole machine turns.
        return [("base_frame", None)] if self.joint == 1 else []

    def shift(self, q, amount):
        moved = q.copy()
        moved[:, self.joint - 1] += amount
        return self.arm.stand(moved).tip - self.arm.stand(q).tip


class LinkLength(_Position):
    """amount: m."""

    name = "link_length"
    most = 0.02

    @property
    def same(self):
        return [("link_offset", self.joint)]

    def shift(self, q, amount):
        return self.arm.stand(q, (self.joint, amount)).tip - self.arm.stand(q).tip


def _direction(rng):
    vector = rng.normal(size=3)
    return {name: float(value) for name, value in zip("xyz", vector / np.linalg.norm(vector))}


class ToolOffset(_Position):
    """amount: m along a direction of the tool frame."""

    name = "tcp_offset"
    most = 0.1

    @property
    def same(self):
        return [("link_offset", self.arm.joints)]

    @classmethod
    def draw(cls, rng, joint, recording, arm):
        return cls(None, _direction(rng), arm)

    def shift(self, q, amount):
        way = np.array([self.numbers[axis] for axis in "xyz"])
        return amount * self.arm.stand(q).tool @ way


class BaseShift(_Position):
    """amount: m along a direction of the base frame."""

    name = "base_frame"
    most = 1.0

    @classmethod
    def draw(cls, rng, joint, recording, arm):
        return cls(None, _direction(rng), arm)

    def shift(self, q, amount):
        return amount * np.array([[self.numbers[axis] for axis in "xyz"]] * len(q))


AT_JOINTS = (ViscousFriction, DryFriction, TorqueOffset, TorqueGain, RotorInertia, TorqueRipple,
             LinkRipple, LinkZero, JointZero, LinkLength)
ANYWHERE = (Payload, LateTorques, ToolOffset, BaseShift)


def _turns_tool(recording, arm):
    """Whether the tool frame has more than one orientation in the recording."""
    turns = arm.stand(angles_of(recording)).tool
    return bool(np.abs(turns - turns[0]).max() > MOVES)


def _places(kind, recording, arm):
    """Joints (or None) at which an effect may be planted."""
    if not [name for name in columns_of(recording, kind.group)
            if np.isfinite(recording[name]).any()]:
        return []
    is_heavy = arm.gravity.any() and not any(arm.slides)
    if kind in (Payload, TorqueGain) and not is_heavy:
        return []  # nothing of known size that a gain could be told from friction and mass by
    if kind in (ToolOffset, BaseShift) and not _turns_tool(recording, arm):
        return []  # either moves every point alike, and no recording tells them apart
    if kind in ANYWHERE:
        return [None]
    span = np.ptp(angles_of(recording), axis=0)
    found = [joint for joint in range(1, arm.joints + 1)
             if span[joint - 1] > MOVES and not (kind.group == "tau" and joint in arm.coupled)]
    if kind is LinkLength:
        return [joint for joint in found if joint < arm.joints and arm.reach(joint) > MOVES]
    if kind.group in ("tau", "q_link"):
        return [joint for joint in found
                if np.isfinite(recording[f"{kind.group}_{joint}"]).any()]
    return found


def drawn(rng, recording, arm, count):
    """`count` Effects, all names about as often."""
    found, kinds = [], [kind for kind in (*AT_JOINTS, *ANYWHERE)
                        if _places(kind, recording, arm)]
    while kinds and len(found) < count:
        for index in rng.permutation(len(kinds)):
            places = _places(kinds[index], recording, arm)
            place = places[rng.integers(len(places))]
            found.append(kinds[index].draw(rng, place, recording, arm))
    return found[:count]
