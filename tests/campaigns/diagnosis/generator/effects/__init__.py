"""The catalogue of effects that can be concealed, by name."""

from . import compliance, geometry, instruments, masses, torques, transmission

CATALOGUE = {effect.name: effect
             for module in (compliance, masses, geometry, transmission, instruments, torques)
             for effect in module.EFFECTS}
