"""Steps of a campaign, case by case, by several processes, each with a sandbox of its own where it needs one."""

import math
import multiprocessing
import shutil
import sys
import time

from . import sandbox
from .cases import leave_signals_to_the_parent

_box = None  # this worker's


class Progress:
    """How far a step is: on a terminal, a line that changes; else one each case."""

    def __init__(self, what, total):
        self._what, self._total, self._begin = what, total, time.monotonic()

    def __call__(self, done):
        left = (time.monotonic() - self._begin) / done * (self._total - done)
        end = "\r" if sys.stderr.isatty() and done < self._total else "\n"
        print(f"{self._what}: {done} of {self._total}, about {math.ceil(left / 60)} min left",
              end=end, file=sys.stderr, flush=True)


def box():
    """The sandbox of the worker that asks."""
    return _box


def _enter(*words):
    global _box
    leave_signals_to_the_parent()
    _box = sandbox.Sandbox(*words) if words else None


def each(jobs, work, tasks, what, box_words=()):
    """Results of work(task), as they come, with progress. box_words: of sandbox.Sandbox, where the work
    asks for `box`."""
    progress, found = Progress(what, len(tasks)), []
    with multiprocessing.Pool(jobs, _enter, box_words) as pool:
        for number, result in enumerate(pool.imap_unordered(work, tasks, chunksize=1), 1):
            found.append(result)
            progress(number)
    return found


def clear(folder, names):
    """Removes what an earlier campaign left in the folder, which is there then."""
    for name in names:
        path = folder / name
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
