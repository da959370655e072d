"""Goals for the TIAGo."""

from ..study import FRICTION, Goal, relative
from .reader import JOINTS, TORQUE_OF_CURRENT

LARGEST_RESIDUAL = 0.164  # a plain regression's 0.156 and 5 %


def judge(trial):
    outcome = trial.outcomes["torques"]
    with_friction = [JOINTS[column] for column in TORQUE_OF_CURRENT
                     if outcome.answer.named(FRICTION, column + 1)]
    left = relative(outcome.errors(outcome.after, "tau"), outcome.signal("tau"))
    return [Goal("friction is named at every joint whose motor reports a current",
                 len(with_friction) == len(TORQUE_OF_CURRENT), f"at {', '.join(with_friction) or 'none'}"),
            Goal(f"relative residual of the held-out part at most {LARGEST_RESIDUAL}",
                 left <= LARGEST_RESIDUAL, f"{left:.3f}")]
