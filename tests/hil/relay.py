"""Carries bytes between serial lines."""

import contextlib
import threading


def carry(read, write):
    """From `read` to `write`, in a thread, until there is no more.

    Each direction of a line needs one of its own: were one loop to serve both, an end that takes no
    more would keep the other from being emptied, and two such loops in a row wait for each other."""
    def run():
        with contextlib.suppress(OSError):  # either end may go at any time
            while data := read():
                write(data)
    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    return thread
