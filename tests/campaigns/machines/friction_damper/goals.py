"""Goals for the friction damper."""

from ..study import FRICTION, Goal, names, relative

LARGEST_RESIDUAL = 0.15


def judge(trial):
    outcome = trial.outcomes["force"]
    named = outcome.answer.named(FRICTION, 1)  # the strongest first
    is_loop_first = bool(named) and named[0].effect == "friction_hysteresis"
    has_play = is_loop_first and named[0].parameters.get("gap", (0.0,))[0] > 0
    residual = relative(outcome.errors(outcome.after, "tau"), outcome.signal("tau"))
    return [
        Goal("hysteresis and play are named before viscous or Coulomb friction", has_play,
             names(named)),
        Goal(f"relative residual of the held-out run at most {LARGEST_RESIDUAL}",
             residual <= LARGEST_RESIDUAL, f"{residual:.3f}")]
