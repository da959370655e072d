"""PAL TIAGo."""

from . import goals, pictures, reader  # noqa: F401
