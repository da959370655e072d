"""Goals for the KR 300."""

import numpy as np

from ..study import FRICTION, Goal, names, speed_of
from . import counterbalance, link_encoders, reader

LEAST_CUT = 0.9  # of the mean torque error of axis 2
LARGEST_DIFFERENCE = 0.1  # of the counterbalance's torque from the published one
SLOW = 0.01  # rad/s: below, friction depends on what went before more than on speed
LOOPS = ("backlash", "hysteresis")


def judge(trial):
    outcome = trial.outcomes["torques"]
    return [_friction(outcome), *_counterbalance(trial, outcome), _torque_error(outcome),
            _encoders(trial.outcomes["encoders"])]


def _friction(outcome):
    axes = [axis for axis in reader.AXES if outcome.answer.named(FRICTION, axis)]
    return Goal("friction is named on all six axes", len(axes) == 6,
                f"on {', '.join(map(str, axes)) or 'none'}")


def _counterbalance(trial, outcome):
    found = outcome.answer.named(("gravity_compensator",), 2)
    named = Goal("the counterbalance is found, on axis 2", bool(found), names(found))
    torque = counterbalance.found_torque(trial, outcome.updated_model.parent)
    text = ("it acts where it does (torque by q2 in the held-out motion within "
            f"{LARGEST_DIFFERENCE:.0%} of the published formula)")
    if torque is None:
        return [named, Goal(text, False, "there is none")]
    q2 = outcome.measured["q_meas_2"]
    published = counterbalance.published_torque(q2)
    known = np.isfinite(torque)
    difference = float(np.linalg.norm((torque - published)[known])
                       / np.linalg.norm(published[known]))
    low, high = np.degrees([np.nanmin(q2), np.nanmax(q2)])
    said = (f"q2 from {round(low)} to {round(high)} degrees: {np.nanmin(torque):.0f} to "
            f"{np.nanmax(torque):.0f} N·m, {difference:.1%} from the published")
    return [named, Goal(text, difference <= LARGEST_DIFFERENCE, said)]


def _torque_error(outcome):
    moves = np.abs(speed_of(outcome.measured, 2)) > SLOW

    def means(rows):
        return [float(np.nanmean(np.abs(outcome.errors(simulated, "tau")[rows, 1])))
                for simulated in (outcome.before, outcome.after)]

    before, after = means(moves)
    all_before, all_after = means(slice(None))
    return Goal("mean torque error of axis 2, held-out motion A, where it moves "
                f"(above {SLOW} rad/s), cut by {LEAST_CUT:.0%}", after <= (1 - LEAST_CUT) * before,
                f"{before:.0f} to {after:.0f} N·m, {1 - after / before:.1%}; with creeping rows "
                f"{all_before:.0f} to {all_after:.0f} N·m, {1 - all_after / all_before:.1%}")


def _encoders(outcome):
    experiment, named = outcome.experiment, outcome.answer.findings
    is_late = bool(named) and named[0].effect == "time_offset"
    beside = []
    for axis in reader.WITH_LINK_ENCODER:
        found = link_encoders.regress([*experiment.recordings, experiment.holdout], axis)
        beside.append(f"axis {axis} {found.delay * 1e3:.2f} ms, {found.explained:.0%}")
    return Goal("motor against link encoders: above all a late encoder, and neither play nor "
                "hysteresis", is_late and not outcome.answer.named(LOOPS),
                f"{names(named)} (regression on speed: {'; '.join(beside)} of the variance)")
