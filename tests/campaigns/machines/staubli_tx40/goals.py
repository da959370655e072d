"""Goals for the TX40."""

import numpy as np
from scipy.signal import butter, sosfiltfilt

from ..study import FRICTION, Goal, rms, speed_of

MOVES = 0.02  # of a joint's largest speed
LARGEST_ERROR = {"filtered": 1.45, "recorded": 1.7}  # N·m


def _in_band(errors, time, below_hz):
    """As slow as the angles can tell of: measured and simulated torques, the same low-pass on both
    (fourth order of Butterworth, forwards and backwards)."""
    if below_hz is None:
        return errors
    rate = 1 / np.median(np.diff(time))
    return sosfiltfilt(butter(4, below_hz / (0.5 * rate), output="sos"), errors, axis=0)


def _moving_error(outcome, simulated):
    """Root mean square of the held-out torques' errors where their joints move, N·m."""
    errors = _in_band(outcome.errors(simulated, "tau"), outcome.measured["t"], outcome.answer.below_hz)
    for joint in range(1, 7):
        speed = np.abs(speed_of(outcome.measured, joint))
        errors[speed < MOVES * speed.max(), joint - 1] = np.nan
    return rms(errors)


def _words_of(below_hz):
    return "" if below_hz is None else f" below {below_hz:.0f} Hz"


def judge(trial):
    goals = []
    for name, outcome in trial.outcomes.items():
        before, after = (_moving_error(outcome, simulated)
                         for simulated in (outcome.before, outcome.after))
        joints = [str(joint) for joint in range(1, 7) if outcome.answer.named(FRICTION, joint)]
        coupled = outcome.answer.named(("transmission",), 6)
        goals += [
            Goal(f"{name}: held-out error where joints move at most {LARGEST_ERROR[name]} N·m",
                 after <= LARGEST_ERROR[name],
                 f"{before:.2f} to {after:.2f} N·m{_words_of(outcome.answer.below_hz)}"),
            Goal(f"{name}: friction is named on all six axes", len(joints) == 6,
                 f"on {', '.join(joints) or 'none'}"),
            Goal(f"{name}: the coupled wrist is named", bool(coupled),
                 str(coupled[0]) if coupled else "not")]
    return goals
