"""Reproductions of papers, claim by claim."""

from . import laulagnet_2011

__all__ = ["laulagnet_2011"]
