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


RECEIPT = b"\x06"  # "acknowledge" in ASCII; slcan's text has none
EACH = 512  # bytes that a receipt stands for
MOST = 3072  # bytes on their way


class Window:
    """Holds back what a guest has not yet read.

    A terminal's buffer holds 4 KB. Where it fills up, user-mode Linux stops listening to the line and never
    begins again. So no more than `MOST` bytes are on their way, and the guest's end of the line answers with a
    receipt for each `EACH` bytes that it has read."""

    def __init__(self):
        self._free = MOST
        self._changed = threading.Condition()

    def send(self, write, data):
        """Writes `data` as fast as receipts come."""
        for start in range(0, len(data), EACH):
            part = data[start:start + EACH]
            with self._changed:
                self._changed.wait_for(lambda size=len(part): self._free >= size)
                self._free -= len(part)
            write(part)

    def without_receipts(self, data):
        """What the guest sent, its receipts taken out and heeded."""
        with self._changed:
            self._free += EACH * data.count(RECEIPT)
            self._changed.notify_all()
        return data.replace(RECEIPT, b"")


class Receipts:
    """The guest's part of a `Window`."""

    def __init__(self, write):
        self._write = write
        self._unanswered = 0

    def give(self, data):
        """Answers for `data`, which has been read; returns it."""
        self._unanswered += len(data)
        count, self._unanswered = divmod(self._unanswered, EACH)
        if count:
            self._write(count * RECEIPT)
        return data
