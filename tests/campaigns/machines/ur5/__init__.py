"""Universal Robots UR5."""

from . import goals, pictures, reader  # noqa: F401
