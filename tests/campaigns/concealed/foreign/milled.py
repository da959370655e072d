"""A circle that a machine with foreign physics mills, corrected by the nominal and by the diagnosed model.

The machine is that of `steady`: its servos follow exactly, its springs are at rest under what they carry.
"""

import subprocess
import tempfile
from pathlib import Path

import numpy as np

from campaign import case as campaign, paths
from loop import closing, milling
from protocol.loops import Loop

from . import cases, steady
from .law import Foreign

GOAL = 0.35  # of the circularity with the nominal model
SHARE = 0.9  # of the circles that what is concealed spoils
CIRCLE = 11  # of the random numbers that draw it


class SteadyCircle(milling.Circle):
    """A Circle on such a machine."""

    def run(self, description, effects, correction=None):
        motion = self.program if correction is None else self._corrected(correction)
        for effect in effects:
            if isinstance(effect, Foreign):
                motion = effect.driven(motion)
        return steady.simulate(description, tuple(effects), motion,
                               np.random.default_rng(self.rng_seed))


def mill(tool, truth, nominal, diagnosed):
    """What closing.measured says of the case of a truth, or {"failed": why}."""
    case = cases.told(truth)
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        try:
            work, effects = cases.rebuild(case, folder / "case")
            rng = np.random.default_rng([*case.seed, CIRCLE])
            drawn = milling.draw(rng, work.description, work.center, work.rated, case.seed[0])
            circle = SteadyCircle(drawn.program, drawn.plane, drawn.rng_seed)
            return closing.measured(closing.Loop(tool, circle, work.description, folder), effects,
                                    nominal, diagnosed)
        except (closing.Failed, campaign.Unsuitable, paths.Unreachable, FloatingPointError,
                subprocess.TimeoutExpired) as error:
            return {"failed": str(error)}


def is_asked(truth):
    """Whether a command can undo the law that is concealed."""
    return bool(truth["foreign"]) and truth["foreign"]["exists"] and truth["foreign"]["undone"]


def is_judged(row):
    """Whether what is concealed spoils a circle enough that correcting it tells something."""
    return "nominal" in row and Loop(**row).is_spoiled


def left(row):
    """Which share of the circularity with the nominal model is left with the diagnosed one."""
    return Loop(**row).ratio
