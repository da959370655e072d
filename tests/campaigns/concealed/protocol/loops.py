"""The loop closed, after the seal was opened: one case of each concealed effect, milled again."""

import dataclasses
import importlib
import multiprocessing

from . import cases, trial

CLEARLY = 4.0  # times the circularity without it: what is concealed spoils the circle


@dataclasses.dataclass
class Loop:
    """Circularities (m, minimum zone) of a circle that the concealed plant mills."""

    uncorrected: float
    without: float  # what is concealed; corrected by the nominal model
    nominal: float  # corrected by the nominal model
    diagnosed: float  # corrected by the diagnosed one

    @property
    def is_spoiled(self):
        """Whether what is concealed matters to the circle; else there is nothing to gain."""
        return self.nominal > CLEARLY * self.without

    @property
    def ratio(self):
        return self.diagnosed / self.nominal


def _close(task):
    return importlib.import_module("loop").close(*task)


def close(tool, drawn, truths, folder, jobs, progress):
    """{case: Loop, or why it could not be closed}, for one case of each effect. drawn: {name: case}
    of the campaign."""
    picked = importlib.import_module("loop").pick(truths)
    tasks = [(tool, drawn[name], folder / "cases" / name / "model/robot.yaml",
              folder / "answers" / name / trial.LEARNED) for name in picked]
    found = {}
    with multiprocessing.Pool(jobs, cases.leave_signals_to_the_parent) as pool:
        for number, (name, result) in enumerate(zip(picked, pool.imap(_close, tasks)), 1):
            found[name] = result["failed"] if "failed" in result else Loop(**result)
            progress(number, len(tasks))
    return found
