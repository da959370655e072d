"""Goals for the UR5."""

from ..study import Goal, mean_norm, names

LARGEST_ERROR = 0.105  # mm
GEOMETRY = ("base_frame", "joint_axis", "joint_offset", "link_length", "tcp_offset")
GIVES_WAY = ("joint_stiffness", "nonlinear_stiffness", "link_flexibility", "base_compliance",
             "tool_compliance")


def judge(trial):
    outcome = trial.outcomes["positions"]
    found = outcome.answer.findings
    is_geometry_first = bool(found) and found[0].effect in GEOMETRY
    sag = outcome.answer.named(GIVES_WAY)
    before, after = (mean_norm(outcome.errors(simulated, "xyz")) * 1e3
                     for simulated in (outcome.before, outcome.after))
    return [
        Goal("geometry is named first", is_geometry_first, names(found)),
        Goal("giving way under weight is named beside it", is_geometry_first and bool(sag),
             names(sag)),
        Goal(f"mean error of the held-out poses at most {LARGEST_ERROR} mm", after <= LARGEST_ERROR,
             f"{before:.3f} to {after:.3f} mm")]
