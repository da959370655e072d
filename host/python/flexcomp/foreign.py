"""What the readers of foreign recordings have in common."""

import importlib


class Unusable(Exception):
    """A file that cannot be converted, in one line for a person."""


def package(module, name, file):
    """An optional package, when it is needed first. Raises Unusable that says how to install it."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        raise Unusable(f"{file}: reading it needs the package {name}: pip install {name}") from error
