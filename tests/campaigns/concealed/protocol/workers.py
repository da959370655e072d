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
    """On a terminal, how far a step is; elsewhere nothing."""

    def __init__(self, what):
        self._what, self._begin = what, time.monotonic()

    def __call__(self, done, total):
        if sys.stderr.isatty():
            left = (time.monotonic() - self._begin) / done * (total - done)
            words = f"{self._what}: {done} of {total}, about {math.ceil(left / 60)} min left"
            print(f"\r{words} \033[K", end="" if done < total else "\n", file=sys.stderr, flush=True)


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
    progress, found = Progress(what), []
    with multiprocessing.Pool(jobs, _enter, box_words) as pool:
        for number, result in enumerate(pool.imap_unordered(work, tasks, chunksize=1), 1):
            found.append(result)
            progress(number, len(tasks))
    return found


def clear(folder, names):
    """Removes what an earlier campaign left in the folder, which is there then; nothing else."""
    for name in names:
        path = folder / name
        if path.is_dir() and not path.is_symlink():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
