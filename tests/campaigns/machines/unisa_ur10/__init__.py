"""Universal Robots UR10."""

from . import goals, pictures, reader  # noqa: F401
