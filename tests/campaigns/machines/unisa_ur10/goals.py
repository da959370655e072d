"""Goals for the UR10."""

from ..study import FRICTION, Goal, relative

JOINTS = range(1, 7)


def judge(trial):
    outcome = trial.outcomes["torques"]
    with_friction = [str(joint) for joint in JOINTS if outcome.answer.named(FRICTION, joint)]
    left = relative(outcome.errors(outcome.after, "tau"), outcome.signal("tau"))
    return [Goal("friction is named at every joint", len(with_friction) == len(JOINTS),
                 f"at {', '.join(with_friction) or 'none'}"),
            Goal("relative residual of the held-out part at most 0.07", left <= 0.07, f"{left:.3f}")]
