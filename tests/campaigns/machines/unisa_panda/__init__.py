"""Another Franka Emika Panda."""

from . import goals, pictures, reader  # noqa: F401
