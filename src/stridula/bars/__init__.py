"""Bars that show how much of a computation is done."""

from .tasks import show_progress

__all__ = ["show_progress"]
