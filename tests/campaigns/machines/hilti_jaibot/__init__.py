"""Hilti JaiBot."""

from . import goals, pictures, reader  # noqa: F401
