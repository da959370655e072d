"""Goals for the Panda."""

from ..study import FRICTION, Goal
from . import reader


def judge(trial):
    outcome = trial.outcomes["torques"]
    with_friction = [str(joint) for joint in reader.JOINTS
                     if outcome.answer.named(FRICTION, joint)]
    return [Goal("friction is named at every joint", len(with_friction) == len(reader.JOINTS),
                 f"at {', '.join(with_friction) or 'none'}")]
