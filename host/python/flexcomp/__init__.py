"""flexcomp for Python: a robot controller's side of the bus, the core, recordings, and the host's commands."""

import importlib

_WHERE = {
    "Answer": "client", "Client": "client", "Refused": "client", "Reply": "client",
    "Compensator": "compensator", "Config": "compensator", "FlexcompError": "compensator", "Output": "compensator",
    "Table": "compensator", "TableInfo": "compensator",
    "Recording": "recording",
    "version": "_core",
}
__all__ = sorted(_WHERE) + ["commands"]


def __getattr__(name):
    """Loads what is asked for alone: who moves frames needs no pandas."""
    if name == "commands":
        return importlib.import_module(f"{__name__}.commands")
    if name in _WHERE:
        return getattr(importlib.import_module(f"{__name__}.{_WHERE[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
