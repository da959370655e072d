"""Goals for the Panda."""

from ..study import FRICTION, Goal
from . import reader


def judge(trial):
    outcome = trial.outcomes["torques"]
    joints = range(1, reader.MODELLED + 1)
    named = {joint: outcome.answer.named(FRICTION, joint) for joint in joints}
    with_friction = [str(joint) for joint in joints if named[joint]]
    return [Goal("friction is named at every joint", len(with_friction) == reader.MODELLED,
                 f"at {', '.join(with_friction) or 'none'}")]
