"""The concealed physics, a class each; names as in diagnosis.json."""

from . import compliance, foreign, geometry, instruments, masses, torques, transmission
from .base import Effect


def _named(modules):
    classes = [entry for module in modules for entry in vars(module).values()
               if isinstance(entry, type) and issubclass(entry, Effect) and entry.name]
    return {entry.name: entry for entry in classes}


EFFECTS = _named([transmission, compliance, masses, geometry, torques, instruments])
FOREIGN = _named([foreign])
