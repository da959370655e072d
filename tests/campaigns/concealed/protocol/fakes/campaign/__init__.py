"""Stands in for the real campaign where the protocol itself is tested: no physics engine."""

from .case import draw, write_case

__all__ = ["draw", "write_case"]
