"""Rotary friction damper."""

from . import goals, pictures, reader  # noqa: F401
