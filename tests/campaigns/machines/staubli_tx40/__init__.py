"""Stäubli TX40."""

from . import goals, pictures, reader  # noqa: F401
