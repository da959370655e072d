"""Draws robots, recordings and the physics concealed in them, and writes them as files."""

from .case import draw, write_case

__all__ = ["draw", "write_case"]
