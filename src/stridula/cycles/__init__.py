"""Periodic motions: limit cycles, their stability and their branches."""

from .limit_cycle import NoCycle, limit_cycle

__all__ = ["NoCycle", "limit_cycle"]
