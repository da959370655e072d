"""The catalogue of effects that can be concealed, by name."""

from . import compliance, geometry, instruments, masses, torques, transmission
from .variants import VARIANTS  # noqa: F401, of the same names in other forms

CATALOGUE = {effect.name: effect
             for module in (compliance, masses, geometry, transmission, instruments, torques)
             for effect in module.EFFECTS}
