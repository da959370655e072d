"""The C API of the core and of a controller's side of the bus, as their own headers declare it."""

import pathlib
import re

import cffi

_HERE = pathlib.Path(__file__).parent
_HEADERS = ("flexcomp.h", "client.h")
_WIDEST = 64  # bytes, to which the widest object of the library is aligned


def _declarations(header):
    """What cffi needs of a header: its declarations for C, and the macros that are numbers."""
    text = re.sub(r"#ifdef __cplusplus\n(.*?)(?:#else\n(.*?))?#endif\n", lambda found: found[2] or "", header,
                  flags=re.DOTALL)
    text = re.sub(r"//.*|/\*.*?\*/", "", text)
    text = re.sub(r"_Alignas\(\d+\)", "", text)
    lines = []
    for line in text.splitlines():
        if not line.startswith("#") or re.fullmatch(r"#define \w+ (0x[0-9A-Fa-f]+|\d+)u?\s*", line):
            lines.append(line)
    return "\n".join(lines)


ffi = cffi.FFI()
for _name in _HEADERS:
    ffi.cdef(_declarations((_HERE / _name).read_text(encoding="utf-8")))
lib = ffi.dlopen(str(_HERE / "libflexcomp.so"))


class FlexcompError(Exception):
    """A refusal of the core, in words; `result` is its number (flexcomp_result_t)."""

    def __init__(self, result, about=""):
        self.result = result
        words = ffi.string(lib.flexcomp_describe_result(result)).decode()
        super().__init__(f"{about}: {words}" if about else words)


def check(result, about=""):
    if result != lib.FLEXCOMP_OK:
        raise FlexcompError(result, about)


def six(values, about):
    """Six numbers as a list; raises ValueError for another count, and TypeError for what is none."""
    numbers = [float(value) for value in values]
    if len(numbers) != 6:
        raise ValueError(f"{about}: expected 6 numbers, not {len(numbers)}")
    return numbers


class Aligned:
    """Zeroed memory of the library's alignment: `pointer`, of a type, for as long as this lives."""

    def __init__(self, kind, size=None):
        size = ffi.sizeof(kind) if size is None else size
        self._room = ffi.new("unsigned char[]", size + _WIDEST)
        address = int(ffi.cast("uintptr_t", self._room))
        self.pointer = ffi.cast(f"{kind} *", self._room + -address % _WIDEST)


def state_name(state):
    """Of flexcomp_state_t, in words."""
    return ffi.string(lib.flexcomp_describe_state(state)).decode()


def status_words(status):
    """The bits of a compensator's status, each in words."""
    return [ffi.string(lib.flexcomp_describe_status_bit(1 << bit)).decode() for bit in range(32) if status >> bit & 1]


def node_words(node_status):
    """The bits of a node's own status, each in words."""
    return [ffi.string(lib.flexcomp_describe_node_bit(1 << bit)).decode() for bit in range(16) if node_status >> bit & 1]


def reply_words(reply):
    """The reply to a command, in words."""
    return ffi.string(lib.flexcomp_describe_reply(reply)).decode()


def version():
    """Of the library."""
    return ffi.string(lib.flexcomp_version()).decode()
