"""Draws effects into a cell so that its recordings show them."""

import dataclasses

from . import detect, machine as physics

DRAWS = 6  # of a size, in one cell


class Unsuitable(Exception):
    """The draw shows too little of its effect, or cannot be told from another."""


@dataclasses.dataclass
class Concealed:
    """An effect as it is concealed."""

    effect: object
    joint: int | None
    parameters: dict
    ratio: float = 0.0
    likest: list = dataclasses.field(default_factory=list)

    @property
    def name(self):
        return self.effect.name


def machine_of(robot, concealed):
    """The robot with the concealed effects."""
    machine = physics.Machine(robot.copy())
    for entry in concealed:
        entry.effect.apply(machine, entry.joint, entry.parameters)
    return machine


def conceal(rng, cell, effect, others, patient=False):
    """Draws one effect into the cell. Raises Unsuitable where the rules of `detect` do not hold."""
    joint = effect.joints[rng.integers(len(effect.joints))]
    if joint and set(cell.takes[0].columns) & set(effect.groups) == {"q_link"}:
        if not cell.quality.link_encoders[joint - 1]:
            raise Unsuitable("no link encoder there")
    entry, machine = _strong_enough(rng, cell, effect, joint)
    trace = cell.difference(machine)
    for likeness in detect.likenesses(trace, others, cell.training, but=(effect.name, joint)):
        if likeness.correlation <= detect.EQUIVALENT:
            if likeness.remainder < detect.REMAINDER:
                raise Unsuitable(f"too like {likeness.effect} of joint {likeness.joint}")
        elif patient:
            raise Unsuitable("another recording may tell it apart")
        entry.likest.append(likeness)
    entry.likest = detect.likest_first(entry.likest)
    return entry, trace


def _strong_enough(rng, cell, effect, joint):
    """The effect in a size that the recordings show, of a few draws."""
    for _ in range(DRAWS):
        parameters = effect.draw(rng, joint, cell.robot, cell.scale)
        entry = Concealed(effect, joint, parameters)
        machine = machine_of(cell.robot, [entry])
        entry.ratio = detect.signal_to_noise(cell.robot, machine, cell.training, cell.levels,
                                             cell.quality, effect.name in detect.LOCAL)
        if entry.ratio >= detect.FACTOR:
            return entry, machine
    raise Unsuitable("too weak")


def rivals(cell, takes):
    return detect.Rivals(cell.robot, takes, cell.levels, cell.quality, cell.scale)
