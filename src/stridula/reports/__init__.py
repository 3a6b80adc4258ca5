"""Reports on systems: one HTML page from the system to its sound."""

from __future__ import annotations

from .reporting import Report, report

__all__ = ["Report", "report"]
