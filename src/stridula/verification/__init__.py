"""Verification cases with known answers, run with every scheme; `verify` runs them all."""

from .report import closing_line, verify

__all__ = ["closing_line", "verify"]
