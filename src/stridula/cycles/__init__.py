"""Periodic motions: limit cycles, their stability and their branches."""

from .limit_cycle import NoCycle, limit_cycle
from .lyapunov import lyapunov_exponent

__all__ = ["NoCycle", "limit_cycle", "lyapunov_exponent"]
