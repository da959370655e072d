"""Goals for the other Panda."""

from ..franka_panda.reader import JOINTS
from ..study import FRICTION, Goal, rms


def judge(trial):
    outcome = trial.outcomes["torques"]
    with_friction = [str(joint) for joint in JOINTS if outcome.answer.named(FRICTION, joint)]
    before, after = (rms(outcome.errors(each, "tau")) for each in (outcome.before, outcome.after))
    return [Goal("friction is named at every joint", len(with_friction) == len(JOINTS),
                 f"at {', '.join(with_friction) or 'none'}"),
            Goal("the held-out part is predicted better than by the first robot's numbers", after < before,
                 f"{before:.3g} to {after:.3g} N·m")]
