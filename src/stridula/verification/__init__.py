"""Cases whose answer is known, run with every scheme and held against it: `verify` runs them all."""

from .report import closing_line, verify

__all__ = ["closing_line", "verify"]
