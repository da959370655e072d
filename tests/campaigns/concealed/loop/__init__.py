"""The loop closed: the concealed plant mills a circle, corrected by the core with the nominal model
and with the diagnosed one."""

from .closing import close, pick

__all__ = ["close", "pick"]
