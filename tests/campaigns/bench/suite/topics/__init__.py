"""A module each, with measure(repetitions) -> result.Topic."""

import importlib

NAMES = ("tick", "instructions", "authentication", "map", "circularity", "table", "diagnose", "bus")


def measure(name, repetitions):
    return importlib.import_module(f".{name}", __package__).measure(repetitions)
