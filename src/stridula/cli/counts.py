"""Counted things in words."""

from __future__ import annotations


def counted(number: int, thing: str) -> str:
    """Return a number of things, such as ``1 mode`` and ``2 modes``."""
    return f"{number} {thing}" if number == 1 else f"{number} {thing}s"
