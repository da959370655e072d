"""Watches the sealed truth: whether anyone opened, read, changed or moved it.

Linux's inotify, by way of the C library, because Python has no call for it. It goes by the file
itself, not by its name, so it also sees those who come by another path or from another mount
namespace. The kernel keeps what happened until it is asked for; no thread is needed.
"""

import ctypes
import os
import struct

# linux/inotify.h
EVENTS = {0x1: "read", 0x2: "written", 0x4: "given other attributes", 0x20: "opened",
          0x400: "deleted", 0x800: "moved"}
LOST = {0x2000: "unmounted", 0x4000: "touched so often that the kernel lost count"}
_HEADER = struct.Struct("iIII")  # watch, mask, cookie, length of the name


class Unwatchable(Exception):
    """The system has no inotify to give."""


class Watch:
    """Watches one file, from here until closed."""

    def __init__(self, path):
        library = ctypes.CDLL(None, use_errno=True)
        self._handle = library.inotify_init1(os.O_NONBLOCK | os.O_CLOEXEC)
        if self._handle < 0:
            raise Unwatchable(os.strerror(ctypes.get_errno()))
        if library.inotify_add_watch(self._handle, os.fsencode(path), sum(EVENTS)) < 0:
            reason = os.strerror(ctypes.get_errno())
            self.close()
            raise Unwatchable(reason)

    def seen(self):
        """Says what was done to the file since last asked, as words."""
        try:
            data = os.read(self._handle, 65536)
        except BlockingIOError:
            return []
        masks, at = 0, 0
        while at < len(data):
            _, mask, _, length = _HEADER.unpack_from(data, at)
            masks, at = masks | mask, at + _HEADER.size + length
        return [word for bit, word in (EVENTS | LOST).items() if masks & bit]

    def close(self):
        os.close(self._handle)
