"""Runs commands where the truth cannot be seen.

Each run has its own mount and process namespaces, whose files are the system's, the ones it is
given and its working folder (enter_sandbox.sh); no network; a bare environment; a time limit. Where
the kernel refuses that, runs have the bare environment, the limit and a private folder only, and
`isolated` says so: the truth is then protected by its seal and the watch on it.
"""

import dataclasses
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import time

ENTER = pathlib.Path(__file__).with_name("enter_sandbox.sh")
NAMESPACES = ("unshare", "--user", "--map-root-user", "--mount", "--pid", "--fork", "--kill-child",
              "--net", "--ipc", "--uts")
ENVIRONMENT = {"PATH": "/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin", "HOME": "/tmp",
               "LANG": "C.UTF-8", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
               "PYTHONDONTWRITEBYTECODE": "1"}
SYSTEM = ("/usr", "/etc", "/bin", "/sbin", "/lib", "/lib32", "/lib64")


@dataclasses.dataclass
class Done:
    """How a run ended."""

    code: int | None  # None: not within its time
    output: str
    errors: str
    seconds: float

    @property
    def last_words(self):
        return next(reversed(self.errors.strip().splitlines()), "")


class Stopped(Exception):
    """The campaign was stopped while this was running."""


def _given_by_system(path):
    return any(path.is_relative_to(folder) for folder in SYSTEM)


def _all_missing(listing, hidden):
    """Whether ls ran and found none of the hidden paths (a failed sandbox says otherwise)."""
    return not listing.output and all(str(path) in listing.errors for path in hidden)


def _kill(process):
    """With all it started: they are of its session, and --kill-child ends a whole namespace."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        pass  # it has just ended


class Sandbox:
    """A way to run commands, the same for a whole campaign; several threads may start runs."""

    def __init__(self, readable, hidden):
        """readable: paths that runs may read besides the system's; hidden: paths that none may."""
        self._readable = [str(path) for path in dict.fromkeys(readable)
                          if not _given_by_system(path)]
        self._running, self._lock, self._stopped = set(), threading.Lock(), False
        self.isolated, self.why_not = True, ""
        with tempfile.TemporaryDirectory() as work:
            tried = self.run(["ls", "-d", *map(str, hidden)], pathlib.Path(work), 30)
        if not _all_missing(tried, hidden):
            self.isolated = False
            self.why_not = (f"{tried.output.strip()} stays visible" if tried.output
                            else tried.last_words or f"unshare ended with {tried.code}")

    def run(self, words, work, limit, environment=()):
        """Runs words in the folder work, for at most limit seconds. environment: added to the bare
        one. Returns Done; raises Stopped."""
        begin = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="root-") as root:
            if self.isolated:
                words = [*NAMESPACES, str(ENTER), root, str(work), *self._readable, "--", *words]
            process = self._start(words, work, ENVIRONMENT | dict(environment))
            try:
                output, errors = process.communicate(timeout=limit)
                code = process.returncode
            except subprocess.TimeoutExpired:
                _kill(process)
                output, errors = process.communicate()
                code = None
            finally:
                with self._lock:
                    self._running.discard(process)
        if self._stopped:
            raise Stopped
        return Done(code, output, errors, time.monotonic() - begin)

    def _start(self, words, work, environment):
        with self._lock:
            if self._stopped:
                raise Stopped
            process = subprocess.Popen(
                words, cwd=work, env=environment, text=True, errors="replace",
                start_new_session=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                stderr=subprocess.PIPE)
            self._running.add(process)
        return process

    def stop(self):
        """Ends what runs, and lets nothing start any more."""
        with self._lock:
            self._stopped = True
            for process in self._running:
                _kill(process)
