"""KUKA KR 300 R2500 ultra SE."""

from . import goals, pictures, reader  # noqa: F401
