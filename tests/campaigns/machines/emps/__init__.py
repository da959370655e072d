"""EMPS, a carriage on a ball screw."""

from . import goals, pictures, reader  # noqa: F401
