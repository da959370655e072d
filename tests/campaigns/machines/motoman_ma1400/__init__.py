"""Yaskawa Motoman MA1400."""

from . import goals, pictures, reader  # noqa: F401
