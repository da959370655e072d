"""Goals for EMPS."""

from ..study import DRY_FRICTION, Goal, names, relative

LARGEST_RESIDUAL = 0.035  # 0.039 without the law of its friction


def judge(trial):
    outcome = trial.outcomes["force"]
    viscous = outcome.answer.named(("viscous_friction",), 1)
    dry = outcome.answer.named(DRY_FRICTION, 1)
    by_direction = [finding for finding in viscous if "backward" in finding.parameters]
    by_direction += outcome.answer.named(("torque_offset",), 1)
    residual = relative(outcome.errors(outcome.after, "tau"), outcome.signal("tau"))

    return [
        Goal("viscous and dry friction are named", bool(viscous and dry), names(viscous + dry)),
        Goal("so is what tells the directions apart", bool(by_direction), names(by_direction)),
        Goal(f"relative residual of the second run at most {LARGEST_RESIDUAL}",
             residual <= LARGEST_RESIDUAL, f"{residual:.3f}")]
