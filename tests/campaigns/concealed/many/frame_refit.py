"""All link frames, zeros, springs, tracker's frame and clock at once, by Levenberg and Marquardt.

Every number is held to the model's by what it can plausibly be off, against noise that is what the
fit leaves: what a recording does not show stays, what it shows well is not held.
"""

import copy
import dataclasses

import numpy as np
from scipy.interpolate import CubicSpline

from . import arm

ROWS = 900  # of a recording, evenly
ROUNDS = 12
LENGTH, ANGLE = 1e-3, 2e-3  # m, rad: one standard deviation of a frame
AWAY, TURNED = 0.1, 0.1  # m, rad: of the tracker
TOOL = 3e-3  # m
SOFTER = 0.5  # of the log of a compliance
LATE = 10e-3  # s
DIFFERENCE = 1e-2  # of a plausible change, for derivatives


@dataclasses.dataclass
class Rows:
    """A recording as the fit sees it."""

    time: np.ndarray
    q: np.ndarray
    xyz: np.ndarray
    wrench: object  # (n, 6) or None
    course: object  # angles by time, or None: poses

    @classmethod
    def of(cls, recording, every=1):
        """Every so many rows of a rivals.recording.Recording."""
        course = None if recording.is_static else CubicSpline(recording.time, recording.angles)
        wrench = recording.groups.get("wrench")
        return cls(recording.time[::every], recording.angles[::every],
                   recording.groups["xyz"][::every], None if wrench is None else wrench[::every],
                   course)

    @property
    def is_motion(self):
        return self.course is not None


class Machine:
    """The nominal arm and how its numbers make it another: all zero is as it was."""

    def __init__(self, description, *, clock=False, base=None):
        """base: (6,) m/N, rad/(N·m), the plausible size of the base's springs, or None."""
        self.description = description
        joints = len(description.chain) - 1
        parts = {"away": [AWAY] * 3, "turned": [TURNED] * 3,
                 "lengths": [LENGTH] * 3 * joints, "angles": [ANGLE] * 3 * joints,
                 "zeros": [ANGLE] * 6, "tool": [TOOL] * 3, "springs": [SOFTER] * 6}
        if clock:
            parts["late"] = [LATE]
        if base is not None:
            parts["base"] = list(base)
        self.tolerance = np.concatenate([np.array(part, float) for part in parts.values()])
        self._slices, first = {}, 0
        for name, part in parts.items():
            self._slices[name] = slice(first, first + len(part))
            first += len(part)

    def part(self, numbers, name):
        return numbers[self._slices[name]] if name in self._slices else None

    def _chain(self, numbers):
        chain = copy.deepcopy(self.description.chain)
        lengths = self.part(numbers, "lengths").reshape(-1, 3)
        angles = self.part(numbers, "angles").reshape(-1, 3)
        for joint, length, angle in zip(chain, lengths, angles):
            joint.position = joint.position + length
            joint.rotation = joint.rotation @ arm.small_turn(angle)
        chain[-1].position = chain[-1].position + self.part(numbers, "tool")
        return chain

    def angles(self, numbers, rows):
        """(n, 6) of the motors at the moments that the tracker saw."""
        late = self.part(numbers, "late")
        q = rows.q
        if late is not None:
            q = rows.course(np.maximum(rows.time - late[0], rows.course.x[0]))
        return q + self.part(numbers, "zeros")

    def places(self, numbers, rows):
        """(n, 3) m of the TCP, as the tracker shows them."""
        nominal = self.description
        q, wrench = self.angles(numbers, rows), rows.wrench
        payload = nominal.payload_mass, nominal.payload_center
        chain = self._chain(numbers)
        load = arm.Frames(chain, q).load(chain, nominal.gravity, payload, wrench)
        springs = nominal.column("compliance") * np.exp(self.part(numbers, "springs"))
        bent = arm.Frames(chain, q + springs * load)
        load = bent.load(chain, nominal.gravity, payload, wrench)
        bent = arm.Frames(chain, q + springs * load)
        point = bent.tip
        give = self.part(numbers, "base")
        if give is not None:
            force = self._base_load(bent, chain, wrench) * give
            point = point + force[:, :3] + np.cross(force[:, 3:], point)
        turn = arm.small_turn(self.part(numbers, "turned"))
        return point @ turn.T + self.part(numbers, "away")

    def _base_load(self, frames, chain, wrench):
        nominal = self.description
        force, moment = np.zeros_like(frames.tip), np.zeros_like(frames.tip)

        def add(point, each):
            force[:] += each
            moment[:] += np.cross(point, each)

        for joint, turn, place in zip(chain, frames.turns, frames.places):
            if joint.body is not None:
                add(place + turn @ joint.body.center, joint.body.mass * nominal.gravity)
        add(frames.tip + frames.tool @ nominal.payload_center,
            nominal.payload_mass * nominal.gravity)
        if wrench is not None:
            add(frames.tip, wrench[:, :3])
            moment += wrench[:, 3:]
        return np.concatenate([force, moment], axis=1)


def _slopes(machine, numbers, rows, here):
    columns = []
    for k, size in enumerate(machine.tolerance):
        moved = numbers.copy()
        moved[k] += DIFFERENCE * size
        columns.append(((machine.places(moved, rows) - here) / DIFFERENCE).ravel())
    return np.column_stack(columns)  # by plausible changes


def fit(machine, recording):
    """The numbers that a recording shows."""
    rows = Rows.of(recording, max(1, len(recording.time) // ROWS))
    target = rows.xyz
    numbers = np.zeros(len(machine.tolerance))
    damping, noise = 1e-3, None
    here = machine.places(numbers, rows)
    for _ in range(ROUNDS):
        left = (target - here).ravel()
        noise = max(np.sqrt(np.mean(left**2)), 1e-7)
        slopes = _slopes(machine, numbers, rows, here) / noise
        scaled = numbers / machine.tolerance
        normal = slopes.T @ slopes + np.eye(len(numbers))
        pull = slopes.T @ (left / noise) - scaled
        cost = left @ left / noise**2 + scaled @ scaled
        for _ in range(8):
            step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), pull)
            tried = numbers + step * machine.tolerance
            there = machine.places(tried, rows)
            after = ((target - there) ** 2).sum() / noise**2 + ((tried / machine.tolerance) ** 2).sum()
            if after <= cost:
                damping = max(damping / 10, 1e-9)
                break
            damping *= 10
        else:
            return numbers
        numbers, here = tried, there
        if cost - after < 1e-6 * cost:
            break
    return numbers


def base_tolerance(truth):
    """(6,) plausible springs of a base that is known to give: as large as they are."""
    give = np.abs(np.array(truth))
    return np.where(give > 0, give, 1e-15)
